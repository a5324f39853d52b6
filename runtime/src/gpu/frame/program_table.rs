//! Pipelines, each built when a frame first needs it.

use super::batch::BatchKey;
use super::program::Program;
use crate::plan::Census;
use std::collections::{BTreeMap, HashMap};

/// What tells a renderer's pipelines apart, but for the format that they draw into.
pub trait ProgramKey: Copy + Ord {
    /// The surfaces that it draws, if it does.
    fn batch(&self) -> Option<&BatchKey>;

    /// Whether it draws into the picture, so that there is one per format.
    fn has_color(&self) -> bool;
}

/// A renderer's pipelines.
pub struct ProgramTable<K> {
    /// By the format that they draw into; none for those that write depth, stencil or shadow maps alone.
    by_format: HashMap<Option<wgpu::TextureFormat>, BTreeMap<K, Program>>,
}

impl<K> Default for ProgramTable<K> {
    fn default() -> Self {
        Self { by_format: HashMap::new() }
    }
}

impl<K: ProgramKey> ProgramTable<K> {
    /// Builds those that are wanted and not there yet.
    pub fn prepare(
        &mut self,
        wanted: impl IntoIterator<Item = K>,
        format: wgpu::TextureFormat,
        make: impl Fn(&K) -> Program,
    ) {
        for key in wanted {
            let programs = self.by_format.entry(key.has_color().then_some(format)).or_default();
            programs.entry(key).or_insert_with(|| make(&key));
        }
    }

    /// One that was prepared.
    pub fn get(&self, key: &K, format: wgpu::TextureFormat) -> &Program {
        &self.by_format[&key.has_color().then_some(format)][key]
    }

    /// The keys of all that were built.
    pub fn keys(&self) -> impl Iterator<Item = &K> {
        self.by_format.values().flat_map(BTreeMap::keys)
    }
}

/// Counts pipelines into a census.
pub fn with_pipelines<'a, K: ProgramKey + 'a>(census: Census, keys: impl Iterator<Item = &'a K>) -> Census {
    keys.fold(census, |census, key| {
        let surface = key.batch().copied();
        Census {
            pipelines: census.pipelines + 1,
            alpha_test_pipelines: census.alpha_test_pipelines
                + usize::from(surface.is_some_and(|batch| batch.surface.has_alpha_mask)),
            two_sided_pipelines: census.two_sided_pipelines
                + usize::from(surface.is_some_and(|batch| batch.is_two_sided)),
            specular_pipelines: census.specular_pipelines
                + usize::from(surface.is_some_and(|batch| batch.surface.look.is_specular)),
            blended_pipelines: census.blended_pipelines
                + usize::from(surface.is_some_and(|batch| batch.surface.look.is_blended)),
            ..census
        }
    })
}
