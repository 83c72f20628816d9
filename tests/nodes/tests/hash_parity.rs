//! The shader's integer hashes equal the CPU's bit for bit.

use glam::IVec3;
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::rainfall::{cell_key, drop_marks, drop_place};

use crate::device::{device, kernel, library};

/// Keys with all bits in use, and the corners.
fn keys() -> Vec<[u32; 4]> {
    let mut keys: Vec<[u32; 4]> = (0..4096_u32)
        .map(|i| {
            let [a, b, c] = pcg3d([i, 7, 11]);
            [a, b, c, i % 500]
        })
        .collect();
    keys.extend([[0; 4], [u32::MAX; 4], [1, 2, 3, 0], [0x8000_0000, 1, 0x7FFF_FFFF, 4095]]);
    keys
}

const PCG: &str = "let h = rain_pcg3d(input[i].xyz); output[i] = vec4<u32>(h, bitcast<u32>(rain_unit(h.x)));";

#[test]
fn hashes_are_bit_equal_on_gpu_and_cpu_and_another_multiplier_is_found() {
    let Some(gpu) = device() else { return };
    let expected: Vec<[u32; 4]> = keys()
        .iter()
        .map(|k| {
            let [x, y, z] = pcg3d([k[0], k[1], k[2]]);
            [x, y, z, unit_f32(x).to_bits()]
        })
        .collect();
    let run = |library: &str| gpu.compute::<_, [u32; 4]>(&kernel(library, "vec4<u32>", "vec4<u32>", PCG), &keys(), &[]);
    assert!(run(&library()) == expected);
    let wrong = library().replacen("1664525u", "1664527u", 1);
    assert_ne!(wrong, library());
    assert!(run(&wrong) != expected);
}

#[test]
fn cell_keys_marks_and_places_are_bit_equal_on_gpu_and_cpu() {
    let Some(gpu) = device() else { return };
    let (seed, class) = (0x0123_4567_89AB_CDEF_u64, 7);
    let stream = pcg3d([seed as u32, (seed >> 32) as u32, class]);
    let body = format!(
        "let key = rain_cell_key(vec3<u32>({}u, {}u, {}u), bitcast<vec3<i32>>(input[i].xyz));
    let marks = rain_drop_marks(key, input[i].w);
    let place = rain_drop_place(key, input[i].w);
    output[i] = vec4<u32>(key.x ^ key.y, marks.x ^ marks.y, bitcast<u32>(place.x), bitcast<u32>(place.z));",
        stream[0], stream[1], stream[2]
    );
    let found = gpu.compute::<_, [u32; 4]>(&kernel(&library(), "vec4<u32>", "vec4<u32>", &body), &keys(), &[]);
    let expected = |k: &[u32; 4], seed: u64| {
        let key = cell_key(seed, class, IVec3::new(k[0] as i32, k[1] as i32, k[2] as i32));
        let (marks, place) = (drop_marks(key, k[3]), drop_place(key, k[3]));
        [
            key[0] ^ key[1],
            marks[0] ^ marks[1],
            unit_f32(place[0]).to_bits(),
            unit_f32(place[2]).to_bits(),
        ]
    };
    for (k, found) in keys().iter().zip(&found) {
        assert_eq!(*found, expected(k, seed), "{k:?}");
        assert_ne!(*found, expected(k, seed + 1), "{k:?} with another seed");
    }
}
