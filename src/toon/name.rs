//! Names of materials, which determine the shading of a mesh.

use std::borrow::Borrow;

use bevy::prelude::*;

/// The name of the material of a mesh, by which a [`ToonScene`](crate::ToonScene) or the
/// [`StyleScene`](crate::toon::StyleScene) of a camera chooses its light.
///
/// Meshes of glTF scenes get it from the file, if they are below a `ToonScene` with
/// [`overrides`](crate::ToonScene::overrides), or are seen by a camera whose style has
/// [`parts`](crate::toon::StyleScene::parts). Meshes that are made by code can have it too.
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq, Eq, Hash)]
#[reflect(Component, Default, Clone, PartialEq, Hash)]
pub struct MaterialName(pub String);

impl MaterialName {
    /// A name.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        Self(name.into())
    }
}

impl From<&str> for MaterialName {
    fn from(name: &str) -> Self {
        Self::new(name)
    }
}

impl Borrow<str> for MaterialName {
    fn borrow(&self) -> &str {
        &self.0
    }
}
