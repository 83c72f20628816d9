//! Height fields: from triangles, images, tables and glTF files.
