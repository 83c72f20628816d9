//! Rain as components and systems, in apps without a renderer.

mod common;
mod cover;
mod press;
mod queries;
mod snapshot;
mod street;
mod weather;
