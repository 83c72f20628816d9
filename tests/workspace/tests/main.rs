//! The repository checks itself: who may depend on whom, licences, duplicate crates, the tables of features and of
//! models, links, and marks of unfinished work. Nothing here needs a graphics device or the network once the workspace
//! has been built.

mod bounds;
mod docs;
mod graph;
mod licences;
mod physics;
mod repository;
mod source;
mod stated_errors;
