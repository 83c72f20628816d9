//! Rain as components and systems, in apps without a renderer.

mod areas;
mod common;
mod cover;
mod foot;
mod gusts;
mod history;
mod lightning;
mod press;
mod queries;
mod snapshot;
mod sound;
mod spout;
mod street;
mod weather;
