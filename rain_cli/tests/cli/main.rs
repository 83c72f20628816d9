//! Tests of the calculator and of the `rain` program, in one binary.

mod bad_input;
mod document;
mod program;
mod streaks;
mod values;
mod weather_model;
mod wet_textures;
