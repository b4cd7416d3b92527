//! Bakes of a whole scene or of a shard, which can be interrupted and gone on with.

use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::bake::{Asked, Baker, Block};
use super::density::Density;
use super::map::Map;
use super::method::RadianceMap;
use super::settings::{PARAMS, asked, asked_directions, coarse, gathered};
use super::shards::{self, Shard, ShardAbout};
use crate::job::Handle;
use crate::lighting::prepared::Origin;
use crate::lighting::{MethodError, Prepared};
use crate::param::Settings;
use crate::reference::World;

/// Blocks that a thread bakes between two looks at what is to be kept.
const AT_ONCE: usize = 4;

/// Share of a job that baking a map to gather from takes, about.
const BEFORE: f32 = 0.2;
/// The same of the coarse map.
const COARSE: f32 = 0.05;

/// A whole bake.
pub(super) fn prepared(world: &World, settings: &Settings, job: &Handle) -> Result<Prepared, MethodError> {
    let shard = run(world, settings, [1, 1], None, |_| (), job)?;
    Ok(shards::whole(&shard.about, &shard.blocks).map_err(MethodError::Unfit)?.prepared)
}

/// Bakes what a shard `[which, of]`, counted from 1, still lacks after `begun`. `keep` is called now and then with what is there. The same for any
/// number of threads, and however often it was interrupted.
pub fn run(
    world: &World,
    settings: &Settings,
    shard: [u32; 2],
    begun: Option<Shard>,
    mut keep: impl FnMut(&Shard),
    job: &Handle,
) -> Result<Shard, MethodError> {
    let directions = asked_directions(settings);
    let asked: Asked = asked(settings);
    let baker = Baker::new(world, &directions, asked)?;
    let origin = Origin::of(&RadianceMap, settings, world.scene());
    let about = ShardAbout { origin, shard, area: baker.area(), blocks: baker.blocks() };
    let mut done = begun.filter(|begun| begun.about == about).unwrap_or(Shard { about, blocks: Vec::new() });
    let missing = done.missing();
    if missing.is_empty() {
        return Ok(done);
    }
    let coarse = match coarse(settings) {
        Some((settings, share)) => Some((prepared(world, &settings, &job.part(0.0, COARSE))?, share)),
        None => None,
    };
    let job = &job.part(if coarse.is_some() { COARSE } else { 0.0 }, 1.0);
    let before = match gathered(settings) {
        Some(settings) => Some(prepared(world, &settings, &job.part(0.0, BEFORE))?),
        None => None,
    };
    let job = &job.part(if before.is_some() { BEFORE } else { 0.0 }, 1.0);
    // As they were baked, whatever frames make of them.
    let plain = Settings::new(PARAMS);
    let mut baker = baker.gathering(before.as_ref().and_then(|prepared| Map::of(prepared, &plain)));
    if let Some((prepared, share)) = &coarse {
        baker = baker.denser(Map::of(prepared, &plain).and_then(Density::new), *share);
    }
    let all = done.about.own().count().max(1);
    let finished = AtomicUsize::new(all - missing.len().min(all));
    for some in missing.chunks(AT_ONCE * rayon::current_num_threads().max(1)) {
        let bake = |index: &u32| {
            let block = baker.block(*index, job)?;
            let finished = finished.fetch_add(1, Ordering::Relaxed) + 1;
            job.set_progress(finished as f32 / all as f32);
            Ok(block)
        };
        let blocks: Vec<Result<Block, MethodError>> = some.par_iter().with_max_len(1).map(bake).collect();
        let mut cancelled = None;
        for block in blocks {
            match block {
                Ok(block) => done.blocks.push(block),
                Err(error) => cancelled = Some(error),
            }
        }
        done.blocks.sort_by_key(|block| block.index);
        keep(&done);
        if let Some(error) = cancelled {
            return Err(error);
        }
    }
    Ok(done)
}

#[cfg(test)]
#[path = "run_tests.rs"]
mod tests;
