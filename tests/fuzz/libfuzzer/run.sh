#!/bin/sh
# Coverage-guided fuzzing of one target: run.sh TARGET SECONDS
# Needs a C++ compiler. Stable Rust does: the coverage passes are plain codegen flags.
set -eu
cd "$(dirname "$0")"
target=$1
seconds=$2
work=${CARGO_TARGET_DIR:-target}/fuzz/$target
mkdir -p "$work" "../regressions/$target"
# Valid inputs to start from, and words of the format.
cargo run --quiet --manifest-path ../../../Cargo.toml -p rain_fuzz -- --target "$target" --export "$work"
triple=$(rustc -vV | sed -n 's/^host: //p')
export RUSTFLAGS="-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
 -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
 -Cllvm-args=-sanitizer-coverage-trace-compares"
cargo build --release --quiet --target "$triple"
RAIN_FUZZ_TARGET=$target exec "${CARGO_TARGET_DIR:-target}/$triple/release/rain_libfuzzer" \
    -max_total_time="$seconds" -max_len=65536 -timeout=20 -rss_limit_mb=2048 \
    -dict="$work.dict" -artifact_prefix="../regressions/$target/" "$work" "../regressions/$target"
