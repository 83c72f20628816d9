//! The shader's look-up in the depth map against its CPU twin and against exact geometry.

use glam::{DVec2, DVec3, Vec2};
use rain_core::cover::lookup::{OPEN_SKY, covered, covered_from, shift_per_metre};
use rain_core::hash::{pcg3d, unit_f32};
use rain_core::rainfall::CLASS_SPEEDS_M_S;
use rain_render::cover::CoverPlacement;

use crate::device::{Device, device, kernel, library};

/// Level roofs: low x, low z, high x, high z, height. Units: m.
const ROOFS: [[f64; 5]; 6] = [
    [-9.0, -9.0, -4.0, -2.0, 2.5],
    [-2.5, -8.0, 2.0, -3.0, 4.0],
    [4.0, -9.0, 9.5, 1.0, 6.0],
    [-8.0, 1.0, -1.0, 4.0, 8.0],
    [1.0, 3.0, 3.0, 9.0, 3.0],
    [-6.0, 6.0, -3.0, 9.0, 5.0],
];

const TEXELS: u32 = 512;
pub const EYE: DVec3 = DVec3::new(0.7, 1.7, -0.4);

pub fn placement() -> CoverPlacement {
    CoverPlacement {
        centre_m: DVec2::new(1.0, 0.5),
        plane_m: 2.0,
        extent_m: 60.0,
        top_m: 9.0,
        range_m: 12.0,
        highest_m: 8.0,
        wind_m_s: DVec2::new(7.0, -3.0),
        inverse_speed_s_m: 0.169,
        texels: TEXELS,
    }
}

/// Height of the highest roof on the mean ray that reaches the reference plane at `q` (world x, z).
fn met(p: &CoverPlacement, q: DVec2) -> Option<f64> {
    let drift = p.wind_m_s * p.inverse_speed_s_m;
    ROOFS
        .iter()
        .filter(|roof| {
            let over = q - (roof[4] - p.plane_m) * drift;
            (roof[0]..=roof[2]).contains(&over.x) && (roof[1]..=roof[3]).contains(&over.y)
        })
        .map(|roof| roof[4])
        .max_by(f64::total_cmp)
}

/// The map as heights above sea level, row by row; `None`: nothing there.
pub fn heights(p: &CoverPlacement) -> Vec<Option<f64>> {
    let texel = p.extent_m / f64::from(TEXELS);
    let corner = p.centre_m - 0.5 * p.extent_m;
    (0..TEXELS * TEXELS)
        .map(|i| {
            met(
                p,
                corner + (DVec2::new(f64::from(i % TEXELS), f64::from(i / TEXELS)) + 0.5) * texel,
            )
        })
        .collect()
}

/// Draws the heights into a depth texture, as a host would.
pub fn depth_map(gpu: &Device, p: &CoverPlacement, heights: &[Option<f64>]) -> wgpu::TextureView {
    let depth: Vec<f32> = heights
        .iter()
        .map(|h| h.map_or(0.0, |h| (1.0 - (p.top_m - h) / p.range_m) as f32))
        .collect();
    depth_texture(gpu, TEXELS, &depth)
}

/// Draws depths into a square depth texture.
pub fn depth_texture(gpu: &Device, texels: u32, depth: &[f32]) -> wgpu::TextureView {
    let values = gpu.buffer(bytemuck::cast_slice(depth), wgpu::BufferUsages::STORAGE);
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: texels,
            height: texels,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth32Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(
            format!(
                "@group(0) @binding(0) var<storage, read> values: array<f32>;
@vertex fn vertex(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {{
    return vec4<f32>(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.5, 1.0);
}}
@fragment fn fragment(@builtin(position) at: vec4<f32>) -> @builtin(frag_depth) f32 {{
    return values[u32(at.y) * {texels}u + u32(at.x)];
}}"
            )
            .into(),
        ),
    });
    let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fragment"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    });
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: values.as_entire_binding(),
        }],
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let mut encoder = gpu
        .device
        .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: None,
            color_attachments: &[],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &view,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
    gpu.queue.submit([encoder.finish()]);
    view
}

/// Points in free air up to 3 m, in world metres, each with 1/v of a class.
fn points() -> Vec<(DVec3, f64)> {
    (0..40_000_u32)
        .map(|i| {
            let [x, y, z] = pcg3d([i, 3, 5]).map(|h| f64::from(unit_f32(h)));
            let place = DVec3::new(-10.0 + 20.0 * x, 3.0 * y, -10.0 + 20.0 * z);
            (place, 1.0 / CLASS_SPEEDS_M_S[i as usize % 12])
        })
        .collect()
}

fn gpu_covered(gpu: &Device, p: &CoverPlacement, heights: &[Option<f64>]) -> Vec<bool> {
    let map = depth_map(gpu, p, heights);
    let params = gpu.buffer(bytemuck::bytes_of(&p.params(EYE)), wgpu::BufferUsages::UNIFORM);
    let input: Vec<[f32; 4]> = points()
        .iter()
        .map(|(place, inverse)| (*place - EYE).as_vec3().extend(*inverse as f32).to_array())
        .collect();
    let bindings = "@group(0) @binding(2) var<uniform> cover: CoverParams;
@group(0) @binding(3) var map: texture_depth_2d;\n";
    let body = "output[i] = u32(rain_covered(map, cover, input[i].xyz, input[i].w));";
    let source = kernel(&(library() + bindings), "vec4<f32>", "u32", body);
    let more = [params.as_entire_binding(), wgpu::BindingResource::TextureView(&map)];
    gpu.compute::<_, u32>(&source, &input, &more)
        .into_iter()
        .map(|c| c != 0)
        .collect()
}

fn share(a: &[bool], b: &[bool]) -> f64 {
    a.iter().zip(b).filter(|(a, b)| a != b).count() as f64 / a.len() as f64
}

#[test]
fn cover_look_up_agrees_with_the_cpu_and_with_geometry_and_a_single_shift_does_not() {
    let Some(gpu) = device() else { return };
    let p = placement();
    let heights = heights(&p);
    let on_gpu = gpu_covered(&gpu, &p, &heights);
    // The CPU's look-up reads the same map, relative to the map's corner and the reference plane.
    let corner = p.centre_m - 0.5 * p.extent_m;
    let texel = p.extent_m / f64::from(TEXELS);
    let height = |q: Vec2| {
        let cell = (q / texel as f32).floor();
        if cell.min_element() < 0.0 || cell.max_element() >= TEXELS as f32 {
            return OPEN_SKY;
        }
        heights[cell.y as usize * TEXELS as usize + cell.x as usize].map_or(OPEN_SKY, |h| (h - p.plane_m) as f32)
    };
    let ask = |place: &DVec3, inverse: f64, single: bool| {
        let wind = p.wind_m_s.as_vec2();
        let shift = shift_per_metre(wind, inverse as f32, p.inverse_speed_s_m as f32);
        let y = place.y - p.plane_m;
        let q = DVec2::new(place.x, place.z) + y * p.inverse_speed_s_m * p.wind_m_s - corner;
        let (q, y, highest) = (q.as_vec2(), y as f32, (p.highest_m - p.plane_m) as f32);
        if single {
            covered_from(y, q, y, shift, height)
        } else {
            covered(q, y, shift, highest, height)
        }
    };
    let points = points();
    let on_cpu: Vec<bool> = points
        .iter()
        .map(|(place, inverse)| ask(place, *inverse, false))
        .collect();
    let single: Vec<bool> = points
        .iter()
        .map(|(place, inverse)| ask(place, *inverse, true))
        .collect();
    let exact: Vec<bool> = points
        .iter()
        .map(|(place, inverse)| {
            ROOFS.iter().any(|roof| {
                let over = DVec2::new(place.x, place.z) - (roof[4] - place.y) * *inverse * p.wind_m_s;
                roof[4] > place.y && (roof[0]..=roof[2]).contains(&over.x) && (roof[1]..=roof[3]).contains(&over.y)
            })
        })
        .collect();
    let covered = exact.iter().filter(|c| **c).count();
    assert!(
        covered > 5_000 && covered < 35_000,
        "{covered} of {} covered",
        exact.len()
    );
    assert!(
        share(&on_gpu, &on_cpu) < 0.005,
        "GPU and CPU differ in {}",
        share(&on_gpu, &on_cpu)
    );
    let off = share(&on_gpu, &exact);
    assert!(off < 0.03, "misclassified {off}");
    // One look-up's correction alone is no substitute.
    assert!(
        share(&single, &on_cpu) > 0.02,
        "a single shift differs in {}",
        share(&single, &on_cpu)
    );
    assert!(
        share(&single, &exact) > 1.5 * off,
        "a single shift: {}, three: {off}",
        share(&single, &exact)
    );
}

/// A house: low x, low z, high x, high z, height; from the ground up. Its walls face the rain along +x, −z.
const HOUSE: [f64; 5] = [-3.0, -8.0, 9.0, 2.0, 8.0];

/// Highest point of the house's inside on the way of rain of `inverse_speed` through `p`.
fn highest_in_house(p: DVec3, drift: DVec2) -> Option<f64> {
    let (mut low, mut high) = (0.0_f64, HOUSE[4]);
    for (at, drift, near, far) in [(p.x, drift.x, HOUSE[0], HOUSE[2]), (p.z, drift.y, HOUSE[1], HOUSE[3])] {
        // At the height y the way is at `at − (y − p.y) drift`.
        let ends = [near, far].map(|side| p.y + (at - side) / drift);
        low = low.max(ends[0].min(ends[1]));
        high = high.min(ends[0].max(ends[1]));
    }
    (high >= low).then_some(high)
}

#[test]
fn walls_stop_the_same_drops_on_the_gpu_as_on_the_cpu_and_as_geometry() {
    let Some(gpu) = device() else { return };
    let p = placement();
    let texel = p.extent_m / f64::from(TEXELS);
    let corner = p.centre_m - 0.5 * p.extent_m;
    let mean = p.inverse_speed_s_m * p.wind_m_s;
    let heights: Vec<_> = (0..TEXELS * TEXELS)
        .map(|i| {
            let q = corner + (DVec2::new(f64::from(i % TEXELS), f64::from(i / TEXELS)) + 0.5) * texel;
            highest_in_house(DVec3::new(q.x, p.plane_m, q.y), mean)
        })
        .collect();
    let on_gpu = gpu_covered(&gpu, &p, &heights);
    let height = |q: Vec2| {
        let cell = (q / texel as f32).floor();
        if cell.min_element() < 0.0 || cell.max_element() >= TEXELS as f32 {
            return OPEN_SKY;
        }
        heights[cell.y as usize * TEXELS as usize + cell.x as usize].map_or(OPEN_SKY, |h| (h - p.plane_m) as f32)
    };
    let [mut cpu, mut starts, mut exact] = [const { Vec::new() }; 3];
    for (place, inverse) in points() {
        let shift = shift_per_metre(p.wind_m_s.as_vec2(), inverse as f32, p.inverse_speed_s_m as f32);
        let y = place.y - p.plane_m;
        let q = (DVec2::new(place.x, place.z) + y * mean - corner).as_vec2();
        let (y, top) = (y as f32, (p.highest_m - p.plane_m) as f32);
        cpu.push(covered(q, y, shift, top, height));
        let mut from = [y, top, 0.5 * (y + top)].into_iter();
        starts.push(from.any(|start| covered_from(start, q, y, shift, height)));
        exact.push(highest_in_house(place, inverse * p.wind_m_s).is_some_and(|high| high > place.y));
    }
    let apart = share(&on_gpu, &cpu);
    assert!(apart < 0.005, "GPU and CPU differ in {apart}");
    let [off, without] = [share(&on_gpu, &exact), share(&starts, &exact)];
    assert!(
        off < 0.01 && without > 2.0 * off,
        "misclassified {off}, without walls {without}"
    );
}

#[test]
fn an_empty_map_and_no_map_cover_nothing() {
    let Some(gpu) = device() else { return };
    let p = placement();
    let nothing = vec![None; (TEXELS * TEXELS) as usize];
    assert!(gpu_covered(&gpu, &p, &nothing).iter().all(|c| !c));
    // A lid over everything covers everything below it: the kernel answers.
    let lid = vec![Some(8.0); (TEXELS * TEXELS) as usize];
    assert!(gpu_covered(&gpu, &p, &lid).iter().all(|c| *c));
}
