//! `docs/calculator.md` says what the program does.

use std::path::Path;

use rain_cli::model::{EXAMPLE_TIMELINE, document, models};

/// What follows this line is written by the program.
const MARK: &str = "<!-- models -->\n";

#[test]
fn the_page_has_the_programs_own_tables_and_results() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/calculator.md");
    let page = std::fs::read_to_string(&path).expect("the page is there");
    let (head, found) = page.split_once(MARK).expect("the page has the mark");
    let wanted = format!("\n{}", document().expect("every example works"));
    if std::env::var_os("RAIN_CREATE_DOCS").is_some() {
        std::fs::write(&path, format!("{head}{MARK}{wanted}")).expect("written");
        return;
    }
    for (a, b) in found.lines().zip(wanted.lines()) {
        assert_eq!(a, b, "RAIN_CREATE_DOCS=1 writes the page anew");
    }
    assert!(found == wanted, "RAIN_CREATE_DOCS=1 writes the page anew");
    assert!(
        head.contains(EXAMPLE_TIMELINE),
        "the page shows the example's hyetograph"
    );
    assert_eq!(wanted.matches("\n## ").count(), models().len());
}
