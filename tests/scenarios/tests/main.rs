//! What rendered frames and masks must show. Names state the claim; a "zero" has a partner above zero in its own test.

mod bad_input;
mod border;
mod determinism;
mod examples;
mod goldens;
mod ground_masks;
mod intensity;
mod measured;
mod moving;
mod real_models;
mod ron_bytes;
mod shelter;
mod street_places;
