//! What can go wrong while a street is written.

use std::path::PathBuf;

/// Why a street could not be generated.
#[derive(Debug, thiserror::Error)]
pub enum StreetError {
    /// A file or folder could not be written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// The system's answer.
        source: std::io::Error,
    },
    /// A texture could not be encoded as PNG.
    #[error("texture {name}: {source}")]
    Encode {
        /// Name of the texture.
        name: String,
        /// The codec's answer.
        source: image::ImageError,
    },
    /// The document could not be written as JSON.
    #[error("glTF document: {source}")]
    Document {
        /// The serialiser's answer.
        source: serde_json::Error,
    },
}
