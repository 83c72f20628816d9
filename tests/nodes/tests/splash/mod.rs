//! Splashes on the GPU: the functions, where they land, which of them there are, and what all together show.

mod functions;
mod scene;
mod view;
