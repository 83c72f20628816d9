//! Height fields: triangles against a brute-force search, tables, images, scenes.

mod csv;
mod gltf;
mod gltf_bad;
mod png;
mod triangles;

use rain_core::surface::height_field::{GridFrame, HeightField, HeightFieldError, ImportLimits};

const LIMITS: ImportLimits = ImportLimits {
    cells: 1 << 26,
    triangles: 1 << 26,
    bytes: 1 << 30,
};

/// The message of an error.
#[track_caller]
fn refused<T: core::fmt::Debug>(result: Result<T, HeightFieldError>, words: &[&str]) {
    let message = result.expect_err("refused").to_string();
    for word in words {
        assert!(message.contains(word), "`{word}` is not in: {message}");
    }
}

#[test]
fn default_limits_are_those_documented() {
    assert_eq!(ImportLimits::default(), LIMITS);
}

#[test]
fn frames_refuse_what_is_no_grid() {
    let frame = |cells, cell_m, origin| GridFrame::new(cells, cell_m, origin, &LIMITS);
    assert!(frame([4096, 4096], 0.25, [1e6, -1e6]).is_ok());
    for bad in [0.0, -1.0, 9e-5, 1.1e4, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        refused(
            frame([2, 2], bad, [0.0; 2]),
            &["cell_m", &bad.to_string(), "0.0001 to 10000 m"],
        );
        refused(GridFrame::around([0.0; 2], [1.0; 2], bad, &LIMITS), &["cell_m"]);
    }
    for bad in [1.1e7, f64::NAN, f64::NEG_INFINITY] {
        refused(frame([2, 2], 1.0, [0.0, bad]), &["origin", "1e7"]);
        refused(
            GridFrame::around([0.0; 2], [1.0, bad], 1.0, &LIMITS),
            &["bounds", "1e7"],
        );
    }
    refused(frame([0, 3], 1.0, [0.0; 2]), &["0 × 3", "at least 1 × 1"]);
    refused(frame([1 << 17, 1], 1.0, [0.0; 2]), &["131072 × 1", "65536"]);
    refused(frame([usize::MAX, usize::MAX], 1.0, [0.0; 2]), &["65536"]);
    refused(frame([10_000, 10_000], 1.0, [0.0; 2]), &["10000 × 10000", "67108864"]);
    refused(
        GridFrame::around([-1e7; 2], [1e7; 2], 1e-4, &LIMITS),
        &["200000000000 × 200000000000"],
    );
}

#[test]
fn a_frame_around_a_box_has_the_cells_it_needs() {
    let cells = |low, high, cell_m| {
        let frame = GridFrame::around(low, high, cell_m, &LIMITS).expect("a frame");
        assert_eq!(frame.origin(), low);
        frame.cells()
    };
    assert_eq!(cells([0.0, 0.0], [10.0, 5.0], 0.25), [40, 20]);
    assert_eq!(cells([0.1, -0.1], [0.4, 0.2], 0.1), [3, 3], "rounding makes no cell");
    assert_eq!(cells([0.0, 0.0], [10.1, 5.0], 0.25), [41, 20]);
    assert_eq!(cells([3.0, 3.0], [3.0, 3.0], 0.25), [1, 1]);
    let frame = GridFrame::new([4, 2], 0.5, [10.0, -3.0], &LIMITS).expect("a frame");
    assert_eq!(frame.centre_m(3, 1), [11.75, -2.25]);
}

#[test]
fn heights_fill_the_grid_and_are_finite_or_holes() {
    let frame = GridFrame::new([3, 2], 1.0, [0.0; 2], &LIMITS).expect("a frame");
    let field = HeightField::new(frame, vec![0.0, 1.0, 2.0, 3.0, f64::NAN, 5.0]).expect("a field");
    assert_eq!(
        (field.height(2, 0), field.height(0, 1), field.height(2, 1)),
        (Some(2.0), Some(3.0), Some(5.0))
    );
    assert!(field.height(1, 1).is_some_and(f64::is_nan));
    assert_eq!(field.holes(), 1);
    for (column, row) in [(3, 0), (0, 2), (usize::MAX, usize::MAX)] {
        assert_eq!(field.height(column, row), None);
    }
    refused(HeightField::new(frame, vec![0.0; 5]), &["5 heights", "6 cells"]);
    for bad in [f64::INFINITY, f64::NEG_INFINITY, 1.1e7] {
        let heights = vec![0.0, 0.0, 0.0, 0.0, bad, 0.0];
        refused(HeightField::new(frame, heights), &["column 1, row 1", "1e7"]);
    }
}
