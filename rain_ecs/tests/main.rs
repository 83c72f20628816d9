//! Rain as components and systems, in apps without a renderer.

mod common;
mod cover;
mod foot;
mod queries;
mod snapshot;
mod street;
mod weather;
