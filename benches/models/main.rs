//! Benchmark of the models.

mod studies;

fn main() {
    for study in studies::all() {
        for variant in &study.variants {
            eprintln!("{} {} {:.3e}", study.name, variant.name, variant.error);
        }
    }
}
