//! What kind of ground a thing is.

use bevy_ecs::prelude::*;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
use rain_core::weather::SurfaceClass;

/// The surface class of an entity's mesh: what its material does with water. Without it hosts guess from the material's
/// name ([`surface_class_of_name`]).
#[derive(Component, Reflect, Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[reflect(opaque)]
#[reflect(Component, Debug, Clone, PartialEq, Default)]
pub struct SurfaceMaterial(pub SurfaceClass);

/// Words in names of materials, the telling ones first.
const WORDS: [(&str, SurfaceClass); 38] = [
    ("asphalt", SurfaceClass::Asphalt),
    ("tarmac", SurfaceClass::Asphalt),
    ("bitumen", SurfaceClass::Asphalt),
    ("grass", SurfaceClass::Grass),
    ("lawn", SurfaceClass::Grass),
    ("meadow", SurfaceClass::Grass),
    ("turf", SurfaceClass::Grass),
    ("gravel", SurfaceClass::Gravel),
    ("pebble", SurfaceClass::Gravel),
    ("shingle", SurfaceClass::Gravel),
    ("ballast", SurfaceClass::Gravel),
    ("concrete", SurfaceClass::Concrete),
    ("cement", SurfaceClass::Concrete),
    ("beton", SurfaceClass::Concrete),
    ("roof", SurfaceClass::Roof),
    ("tile", SurfaceClass::Roof),
    ("metal", SurfaceClass::Roof),
    ("steel", SurfaceClass::Roof),
    ("tin", SurfaceClass::Roof),
    ("slate", SurfaceClass::Roof),
    ("cobble", SurfaceClass::Stone),
    ("paving", SurfaceClass::Stone),
    ("paver", SurfaceClass::Stone),
    ("pavement", SurfaceClass::Stone),
    ("sidewalk", SurfaceClass::Stone),
    ("stone", SurfaceClass::Stone),
    ("brick", SurfaceClass::Stone),
    ("sett", SurfaceClass::Stone),
    ("rock", SurfaceClass::Stone),
    ("kerb", SurfaceClass::Stone),
    ("curb", SurfaceClass::Stone),
    ("soil", SurfaceClass::Soil),
    ("dirt", SurfaceClass::Soil),
    ("mud", SurfaceClass::Soil),
    ("earth", SurfaceClass::Soil),
    ("sand", SurfaceClass::Soil),
    ("terrain", SurfaceClass::Soil),
    ("road", SurfaceClass::Asphalt),
];

/// The class that a material's name tells of, in any case; none if it tells nothing.
///
/// Short words (up to four letters) must stand alone or at the start or end of a part of the name, so that "martini"
/// is no tin; the first word of the list that occurs counts: a "gravel road" is gravel.
#[must_use]
pub fn surface_class_of_name(name: &str) -> Option<SurfaceClass> {
    let name = name.to_lowercase();
    let parts = || name.split(|c: char| !c.is_alphabetic()).filter(|part| !part.is_empty());
    WORDS
        .into_iter()
        .find(|(word, _)| {
            if word.len() <= 4 {
                parts().any(|part| part == *word || part.strip_suffix('s') == Some(word))
            } else {
                name.contains(word)
            }
        })
        .map(|(_, class)| class)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_the_class() {
        for (name, class) in [
            ("Asphalt_01", Some(SurfaceClass::Asphalt)),
            ("mat.road.002", Some(SurfaceClass::Asphalt)),
            ("Gravel Road", Some(SurfaceClass::Gravel)),
            ("ConcreteWall", Some(SurfaceClass::Concrete)),
            ("cobblestone", Some(SurfaceClass::Stone)),
            ("roof-tiles", Some(SurfaceClass::Roof)),
            ("rusty METAL", Some(SurfaceClass::Roof)),
            ("grass", Some(SurfaceClass::Grass)),
            ("mud", Some(SurfaceClass::Soil)),
            ("Martini glass", None),
            ("broad leaf", None),
            ("", None),
            ("Straße", None),
        ] {
            assert_eq!(surface_class_of_name(name), class, "{name}");
        }
    }
}
