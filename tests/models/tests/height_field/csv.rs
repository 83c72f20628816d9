//! Tables of heights.

use std::io::Read;

use proptest::prelude::*;
use rain_core::surface::height_field::{HeightField, HeightFieldError, ImportLimits};

use super::{LIMITS, refused};

fn read(text: &str) -> Result<HeightField, HeightFieldError> {
    HeightField::from_csv(text.as_bytes(), 0.5, &LIMITS)
}

#[test]
fn rows_are_z_and_columns_are_x() {
    let field = read("0,1,2\n3,4,5\n").expect("a table");
    assert_eq!(field.cells(), [3, 2]);
    assert_eq!(field.cell_m(), 0.5);
    assert_eq!(field.frame().origin(), [0.0, 0.0]);
    assert_eq!(field.heights(), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    assert_eq!(field.height(2, 1), Some(5.0));
}

#[test]
fn nan_and_nothing_are_holes() {
    let field = read("0,NaN,\n, nan ,-1.5e-3\n").expect("a table");
    let holes: Vec<bool> = field.heights().iter().map(|h| h.is_nan()).collect();
    assert_eq!(holes, [false, true, true, true, true, false]);
    assert_eq!(field.height(2, 1), Some(-1.5e-3));
}

#[test]
fn what_editors_leave_is_tolerated() {
    let field = read("\u{feff}# heights in m\r\n 1 , 2 \r\n\r\n3,4").expect("a table");
    assert_eq!(field.heights(), [1.0, 2.0, 3.0, 4.0]);
}

#[test]
fn mistakes_are_refused_with_line_and_column() {
    refused(read("0,1\n2,x\n"), &["line 2, column 2", "\"x\"", "not a number"]);
    refused(read("# a\n\n0,1,2\n0,1\n"), &["line 4, column 3", "2 heights", "3"]);
    refused(read("0,1\n0,1,2\n"), &["line 2, column 3", "3 heights", "2"]);
    refused(read("0,inf\n"), &["line 1, column 2", "inf", "-1e7 to 1e7 m"]);
    refused(read("0,1\n-2e7,0\n"), &["line 2, column 1", "-20000000"]);
    refused(read("1;2\n"), &["line 1, column 1", "\"1;2\""]);
    refused(read("\"1\",2\n"), &["line 1, column 1"]);
    refused(read(""), &["line 1, column 1", "no rows"]);
    refused(read("# nothing\n\n"), &["no rows"]);
    let not_utf8 = HeightField::from_csv(&b"0,1\n\xff\xfe,2\n"[..], 0.5, &LIMITS);
    refused(not_utf8, &["line 2", "cannot read"]);
}

#[test]
fn large_tables_are_refused_before_they_are_held() {
    let small = ImportLimits { cells: 6, ..LIMITS };
    assert!(HeightField::from_csv(&b"1,2,3\n4,5,6\n"[..], 1.0, &small).is_ok());
    refused(
        HeightField::from_csv(&b"1,2,3\n4,5,6\n7,8,9\n"[..], 1.0, &small),
        &["line 3", "more than 6"],
    );
    let short = ImportLimits { bytes: 8, ..LIMITS };
    assert!(HeightField::from_csv(&b"1,2\n3,4\n"[..], 1.0, &short).is_ok());
    refused(
        HeightField::from_csv(&b"1,2\n3,4\n5,6\n"[..], 1.0, &short),
        &["longer than 8 bytes"],
    );
    // An endless stream ends.
    let endless = std::io::repeat(b'1');
    let limits = ImportLimits {
        bytes: 1 << 16,
        ..LIMITS
    };
    assert!(HeightField::from_csv(endless, 1.0, &limits).is_err());
    refused(HeightField::from_csv(&b"1"[..], f64::NAN, &LIMITS), &["cell_m is NaN"]);
}

#[test]
fn a_line_without_end_is_not_held() {
    let limits = ImportLimits::default();
    for (piece, words) in [
        (&b","[..], ["line 2", "more than 67108864 heights"]),
        (b"0,", ["line 2", "more than 67108864 heights"]),
        (b" ", ["line 2", "longer than 16777216 bytes"]),
        (b"1", ["line 2", "longer than 16777216 bytes"]),
    ] {
        // What a gigabyte would be, of which the reader may take no more than it needs.
        let mut text = b"0,1\n".chain(Endless { piece, read: 0 });
        let used = allocation_counter::measure(|| {
            refused(HeightField::from_csv(&mut text, 0.5, &limits), &words);
        });
        assert!(used.bytes_max < 70 << 20, "{words:?}: {} bytes", used.bytes_max);
        let read = text.get_ref().1.read;
        assert!(read < 17 << 20, "{words:?}: {read} bytes read");
    }
    // The longest row that is allowed.
    let row = "0,".repeat(65_535) + "0\n";
    let field = HeightField::from_csv(row.as_bytes(), 0.5, &limits).expect("a row");
    assert_eq!(field.cells(), [65_536, 1]);
    refused(
        HeightField::from_csv(("0,".to_owned() + &row).as_bytes(), 0.5, &limits),
        &["line 1", "65536 along a side"],
    );
    let row = format!("0,{}1\n", " ".repeat((1 << 24) - 3));
    assert!(HeightField::from_csv(row.as_bytes(), 0.5, &limits).is_ok());
    // Comments are not kept.
    let text = format!("#{}\n0,1\n", ",".repeat(20 << 20));
    assert!(HeightField::from_csv(text.as_bytes(), 0.5, &limits).is_ok());
}

/// The same bytes over and over.
struct Endless {
    piece: &'static [u8],
    read: usize,
}

impl Read for Endless {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        for (index, byte) in buffer.iter_mut().enumerate() {
            *byte = self.piece[(self.read + index) % self.piece.len()];
        }
        self.read += buffer.len();
        Ok(buffer.len())
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(11), ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_is_read_back(
        nx in 1_usize..9,
        heights in proptest::collection::vec(prop_oneof![8 => -1e7..1e7_f64, 1 => Just(f64::NAN), 1 => Just(-0.0)], 1..60),
    ) {
        let rows = heights.len().div_ceil(nx);
        let mut heights = heights;
        heights.resize(rows * nx, 0.5);
        let text: String = heights
            .chunks(nx)
            .map(|row| row.iter().map(|h| format!("{h:?}")).collect::<Vec<_>>().join(",") + "\n")
            .collect();
        let field = read(&text).expect("a table");
        prop_assert_eq!(field.cells(), [nx, rows]);
        for (a, b) in field.heights().iter().zip(&heights) {
            prop_assert!(a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()));
        }
    }
}
