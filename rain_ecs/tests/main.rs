//! Rain as components and systems, in apps without a renderer.

mod areas;
mod common;
mod cover;
mod foot;
mod history;
mod press;
mod queries;
mod snapshot;
mod street;
mod weather;
