//! The carriageway's picture: what a seed varies.

use street::textures::Picture;
use street::textures::ground::asphalt_colour;

/// Texels that are a quarter darker than the row about them: cracks, tar, borders of rubber.
fn lines(picture: &Picture) -> Vec<bool> {
    const REACH: usize = 24;
    let width = picture.width as usize;
    let step = usize::from(picture.channels);
    let mut dark = Vec::with_capacity(width * picture.height as usize);
    for row in picture.bytes.chunks_exact(width * step) {
        let light: Vec<f32> = row
            .chunks_exact(step)
            .map(|texel| (f32::from(texel[1]) / 255.0).powf(2.2))
            .collect();
        for x in 0..width {
            let about = &light[x.saturating_sub(REACH)..(x + REACH).min(width)];
            let mean = about.iter().sum::<f32>() / about.len() as f32;
            dark.push(light[x] < 0.75 * mean);
        }
    }
    dark
}

/// How many texels of either are in both.
fn common(a: &[bool], b: &[bool]) -> f64 {
    let both = a.iter().zip(b).filter(|(a, b)| **a && **b).count();
    let either = a.iter().zip(b).filter(|(a, b)| **a || **b).count();
    both as f64 / either.max(1) as f64
}

#[test]
fn a_seed_varies_place_and_number_of_cracks_and_dirt() {
    let roads: Vec<Vec<bool>> = [1, 2, 3].map(|seed| lines(&asphalt_colour(seed))).to_vec();
    let shares: Vec<f64> = roads
        .iter()
        .map(|road| road.iter().filter(|dark| **dark).count() as f64 / road.len() as f64)
        .collect();
    for (i, share) in shares.iter().enumerate() {
        assert!((0.005..0.2).contains(share), "road {i} is cracked over {share}");
        for j in 0..i {
            let same = common(&roads[i], &roads[j]);
            assert!(same < 0.3, "roads {i} and {j} have {same} of their cracks in common");
            let ratio = shares[i] / shares[j];
            assert!(
                !(0.99..1.01).contains(&ratio),
                "roads {i} and {j} have as many cracks: {ratio}"
            );
        }
    }
    let again = common(&lines(&asphalt_colour(2)), &roads[1]);
    assert!((again - 1.0).abs() < 1e-12, "one seed, two roads: {again}");
}
