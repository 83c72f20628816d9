//! Splashes on the GPU: the functions, where they land, which of them there are, and what all together show.

mod feet;
mod functions;
mod lamps;
mod scene;
mod spouts;
mod view;
