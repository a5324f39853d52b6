//! Stages with less on them: fewer lights, fewer bits, fewer maps.

use super::Stage;
use crate::playback::page_variant;
use sunbake::lamp::LampPath;
use sunbake::maps::{Bits, Lane};
use sunbake_shaders::AmbientModel;

impl Stage {
    /// The same stage with a lamp, whose times are in the pages. Its path is in world space.
    pub fn with_lamp(self, lamp: Option<&LampPath>) -> Self {
        Self { lamp: lamp.map(|path| path.relative_to(self.scene.centre_m)), ..self }
    }

    /// The same stage without the maps that a model of ambient light does not read, so that none of them is bound or
    /// uploaded. A model that the maps do not allow falls back to the best that they do.
    pub fn with_ambient(mut self, model: AmbientModel) -> Self {
        for page in &mut self.pages {
            if model == AmbientModel::Hemisphere {
                page.ambient = None;
            }
            let sides = page
                .ambient
                .iter_mut()
                .flat_map(|ambient| std::iter::once(&mut ambient.front).chain(&mut ambient.back));
            for side in sides {
                side.sky = side.sky.take().filter(|_| model == AmbientModel::Sky);
                side.bent = side.bent.take().filter(|_| model >= AmbientModel::Bent);
            }
        }
        self
    }

    /// The best model of ambient light that the maps of every page allow. The page of surfaces that were not baked has
    /// no such map, and does not count.
    pub fn best_ambient(&self) -> AmbientModel {
        let models = self.pages.iter().map(|page| page_variant(page, self.bits, 0.0).ambient);
        models.filter(|&model| model != AmbientModel::Hemisphere).min().unwrap_or_default()
    }

    /// The same stage with times of 8 bits; 16 bits are rounded.
    pub fn with_eight_bits(mut self) -> Self {
        let bits = std::mem::replace(&mut self.bits, Bits::Eight);
        self.pages = self.pages.into_iter().map(|page| page.with_eight_bits(bits)).collect();
        self
    }

    /// The same stage with only the middle lane of the sun's disc, as a bake with one lane has it.
    pub fn with_one_lane(mut self) -> Self {
        for page in &mut self.pages {
            let middle = page.lanes.len() / 2;
            page.lanes.truncate(middle + 1);
            page.lanes.drain(..middle);
            page.lanes.iter_mut().for_each(|lane| lane.lane = Lane::CENTRE);
        }
        self
    }

    /// The same stage without the sun's times, so that none is bound or uploaded.
    pub fn without_sun(mut self) -> Self {
        for page in &mut self.pages {
            page.lanes.clear();
            page.tracks = None;
        }
        self
    }

    /// The same stage without the times of sun and lamp, for techniques that compute shadows themselves. The lights'
    /// paths stay.
    pub fn without_times(mut self) -> Self {
        self.pages.iter_mut().for_each(|page| page.lamp = None);
        self.without_sun()
    }

    /// The same stage without its lamp.
    pub fn without_lamp(mut self) -> Self {
        self.pages.iter_mut().for_each(|page| page.lamp = None);
        Self { lamp: None, ..self }
    }
}
