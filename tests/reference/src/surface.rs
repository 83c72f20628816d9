//! Film, infiltration, inlets and wet albedo.
