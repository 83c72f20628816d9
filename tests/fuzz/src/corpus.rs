//! Valid inputs to start from, and the words of each format.

use std::io::Cursor;

use image::{DynamicImage, ImageBuffer, ImageFormat};

use crate::glb::{Builder, Mode, square};
use crate::target::Target;

/// Inputs that the target takes for valid.
#[must_use]
pub fn corpus(target: Target) -> Vec<Vec<u8>> {
    let texts = |list: &[&str]| list.iter().map(|text| text.as_bytes().to_vec()).collect();
    match target {
        Target::Hyetograph => texts(&[
            "time_s,intensity_mm_h\n0,0\n60,25\n120,0\n",
            "\u{feff}# a storm\r\nintensity_mm_h , time_s\r\n1.5, 0\r\n\r\n500,1e3\r\n",
            "time_s,intensity_mm_h,wind_x_m_s,wind_z_m_s,air_temperature_c,relative_humidity\n0,1,2,-3,15,0.9\n",
        ]),
        Target::Csv => texts(&[
            "0,1,2\n3,NaN,5\n6,7,8\n",
            "# metres\n1e-3 , -2.5\r\n, nan\r\n",
            "5\n",
            "1,1,1,1,1\n1,0,0,0,1\n1,0,-1,0,1\n1,0,0,0,1\n1,1,1,1,1\n",
        ]),
        Target::Png => images(),
        Target::Gltf => scenes(),
        Target::Model => texts(&[
            "terminal-speed\ndiameter_mm=2\nfit=default",
            "rainfall\nintensity_mm_h=25\ndistribution=thunderstorm\nrenormalise=true\nmin_diameter_mm=0.5",
            "visibility\nintensity_mm_h=25\ndistance_m=100",
            "drop-shape\ndiameter_mm=3",
            "fall\ndiameter_mm=5\nheight_m=2",
            "streak\ndiameter_mm=2\nexposure_s=0.0167",
            "fresnel\nangle_deg=60\nior=1.5",
            "canopy\nlai=4\nkind=needle\nintensity_mm_h=10\nduration_s=600\nevaporation_mm_h=0.5",
            "sheet-flow\nmanning_n=0.015\nslope=0.02\nlength_m=5\nintensity_mm_h=50",
            "road-film\ntexture_depth_mm=0.5\nlength_m=5\nintensity_mm_h=50\nslope=0.02\nfit=gallaway79",
            "hydroplaning\npressure_kpa=220",
            "wheel\nspeed_km_h=90\nwidth_mm=200\nfilm_mm=0.5\ntread_mm=3\npressure_kpa=250",
            "wet-albedo\nalbedo=0.2",
        ]),
    }
}

/// Words of the format.
#[must_use]
pub fn words(target: Target) -> Vec<&'static str> {
    match target {
        Target::Hyetograph => vec![
            "time_s",
            "intensity_mm_h",
            "wind_x_m_s",
            ",",
            "\n",
            "\r\n",
            "#",
            "\"",
            "\u{feff}",
        ],
        Target::Csv => vec![",", "\n", "\r\n", "NaN", "inf", "#", "\"", "\u{feff}", "1e-308", ",,,,"],
        Target::Png => vec!["IHDR", "IDAT", "IEND", "PLTE", "tRNS", "gAMA", "acTL", "zTXt", "iCCP"],
        Target::Gltf => vec![
            "\"bufferView\":",
            "\"byteOffset\":",
            "\"byteLength\":",
            "\"byteStride\":",
            "\"count\":",
            "\"children\":",
            "\"mesh\":",
            "\"sparse\":",
            "\"indices\":",
            "\"mode\":",
            "\"matrix\":",
            "\"scale\":",
            "\"rotation\":",
            "null",
            "[",
            "]",
            "{",
            "}",
            "5120",
            "5126",
            "\"VEC3\"",
            "\"MAT4\"",
            "\"extras\":",
            "\"canopy\"",
            "data:;base64,",
            "%ff",
            "\"extensionsRequired\":",
        ],
        Target::Model => rain_cli::model::words(),
    }
}

fn images() -> Vec<Vec<u8>> {
    let gradient = |x: u32, y: u32| (x * 7919 + y * 104_729) as u16;
    let list: [DynamicImage; 5] = [
        DynamicImage::ImageLuma16(ImageBuffer::from_fn(5, 4, |x, y| image::Luma([gradient(x, y)]))),
        DynamicImage::ImageLuma8(ImageBuffer::from_fn(7, 3, |x, y| image::Luma([gradient(x, y) as u8]))),
        DynamicImage::ImageLumaA16(ImageBuffer::from_fn(3, 3, |x, y| {
            image::LumaA([gradient(x, y), 65535 * (x % 2) as u16])
        })),
        DynamicImage::ImageLumaA8(ImageBuffer::from_fn(2, 2, |x, y| {
            image::LumaA([gradient(x, y) as u8, 255])
        })),
        DynamicImage::ImageLuma8(ImageBuffer::from_fn(1, 1, |_, _| image::Luma([0]))),
    ];
    list.iter()
        .map(|image| {
            let mut bytes = Cursor::new(Vec::new());
            image
                .write_to(&mut bytes, ImageFormat::Png)
                .expect("a small image is encoded");
            bytes.into_inner()
        })
        .collect()
}

fn scenes() -> Vec<Vec<u8>> {
    // A strip, and a mirrored, nested and turned fan under it.
    let mut a = Builder::default();
    let strip = a.positions(&square([0.0, 1.0, 0.0]));
    let fan = a.positions(&[[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.5, 1.0], [1.0, 0.0, 0.0]]);
    let opaque = a.material(r#""name":"tarmac""#);
    let strip = a.mesh(strip, None, Mode::Strip, Some(opaque), r#""name":"road""#);
    let fan = a.mesh(fan, None, Mode::Fan, None, "");
    let child = a.node(
        &format!(r#""mesh":{fan},"scale":[-1,2,1],"rotation":[0,0.7071068,0,0.7071068]"#),
        false,
    );
    a.node(
        &format!(r#""mesh":{strip},"translation":[5,0,3],"children":[{child}]"#),
        true,
    );

    // Indexed and sparse, a canopy and a masked mesh.
    let mut b = Builder::default();
    let corners = b.positions(&square([0.0, 0.0, 0.0]));
    let order = [0, 1, 2, 2, 1, 3];
    let narrow = b.indices(&order, 1);
    let wide = b.indices(&order, 4);
    let moved = b.sparse_positions(4, &[(1, [0.0, 0.0, 1.0]), (2, [1.0, 0.0, 0.0]), (3, [1.0, 0.5, 1.0])]);
    let middle = b.indices(&order, 2);
    let masked = b.material(r#""alphaMode":"MASK""#);
    for mesh in [
        b.mesh(corners, Some(narrow), Mode::Triangles, None, ""),
        b.mesh(corners, Some(wide), Mode::Triangles, Some(masked), ""),
        b.mesh(
            moved,
            Some(middle),
            Mode::Triangles,
            None,
            r#""extras":{"canopy":true}"#,
        ),
        b.mesh(moved, Some(middle), Mode::Triangles, None, ""),
    ] {
        b.node(
            &format!(r#""mesh":{mesh},"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,1,2,3,1]"#),
            true,
        );
    }

    // The same as text, its buffer inside.
    let mut c = Builder::default();
    let triangle = c.positions(&[[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]);
    let mesh = c.mesh(triangle, None, Mode::Triangles, None, "");
    c.node(&format!(r#""mesh":{mesh}"#), true);
    let text = c.json(Some(&format!(
        "data:application/octet-stream;base64,{}",
        base64(c.binary())
    )));
    vec![a.glb(), b.glb(), c.glb(), text.into_bytes()]
}

/// Base64 with padding.
#[must_use]
pub fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    for chunk in bytes.chunks(3) {
        let word = chunk.iter().fold(0_u32, |word, byte| word << 8 | u32::from(*byte)) << (8 * (3 - chunk.len()));
        for i in 0..4 {
            let letter = LETTERS[(word >> (18 - 6 * i)) as usize & 63];
            out.push(if i <= chunk.len() { char::from(letter) } else { '=' });
        }
    }
    out
}
