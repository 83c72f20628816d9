//! The repository checks itself: who may depend on whom, licences, duplicate crates, the feature table, links, and
//! marks of unfinished work. Nothing here needs a graphics device or the network once the workspace has been built.

mod docs;
mod graph;
mod licences;
mod repository;
mod source;
