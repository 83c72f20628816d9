//! One target, named by the environment variable `RAIN_FUZZ_TARGET`, under libFuzzer.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use rain_fuzz::{Target, attempt_mended};

static TARGET: LazyLock<Target> = LazyLock::new(|| {
    let name = std::env::var("RAIN_FUZZ_TARGET").unwrap_or_default();
    let all = Target::ALL.map(Target::name).join(", ");
    Target::named(&name).unwrap_or_else(|| panic!("RAIN_FUZZ_TARGET is {name:?}, allowed: {all}"))
});

fuzz_target!(|bytes: &[u8]| {
    if let Err(failure) = attempt_mended(*TARGET, bytes) {
        panic!("{}: {failure:?}", TARGET.name());
    }
});
