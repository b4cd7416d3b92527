//! Blocks of a bake in files: shards that several machines bake, and what is kept of a bake that was interrupted.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use half::f16;
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::bake::{Block, GROUPS, assembled, noise};
use super::directions::Directions;
use crate::file::{Array, Container, Element, FileError, Kind};
use crate::lighting::bakes::{About, Bake};
use crate::lighting::prepared::Origin;

/// The kind of file.
pub const KIND: Kind = Kind { id: "bake-shard", version: 1 };

/// Largest file that is read.
const MAX_BYTES: u64 = 16 << 30;

/// Blocks of a bake.
#[derive(Clone, Debug, PartialEq)]
pub struct Shard {
    /// What they are of.
    pub about: ShardAbout,
    /// In the order of their indices.
    pub blocks: Vec<Block>,
}

/// What a shard is a part of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShardAbout {
    /// What the whole is made of.
    pub origin: Origin,
    /// Which one, from 1 on, of how many: block b belongs to shard b mod N + 1.
    pub shard: [u32; 2],
    /// Area of all surfaces, square metres.
    pub area: f64,
    /// Blocks of the whole.
    pub blocks: u32,
}

impl ShardAbout {
    /// Blocks that belong to it.
    pub fn own(&self) -> impl Iterator<Item = u32> + use<> {
        let [which, of] = self.shard;
        (which.saturating_sub(1)..self.blocks).step_by(of.max(1) as usize)
    }
}

impl Shard {
    /// Blocks that belong to it and are not there.
    pub(super) fn missing(&self) -> Vec<u32> {
        let is_there = |index: &u32| self.blocks.binary_search_by_key(index, |block| block.index).is_ok();
        self.about.own().filter(|index| !is_there(index)).collect()
    }

    /// Rays that were cast for it.
    pub fn rays(&self) -> u64 {
        self.blocks.iter().map(|block| u64::from(block.rays)).sum()
    }

    /// Memory of its light.
    pub fn bytes(&self) -> u64 {
        let of = |block: &Block| block.groups.iter().map(|light| 2 * light.len() as u64).sum::<u64>();
        self.blocks.iter().map(of).sum()
    }

    /// Writes the file, whole or not at all.
    pub fn write(&self, path: &Path) -> Result<(), FileError> {
        let Shard { about, blocks } = self;
        let header = json!({ "about": about, "software": concat!("Burnish ", env!("CARGO_PKG_VERSION")) });
        let all = |of: fn(&Block) -> &[f32]| -> Vec<f32> { blocks.iter().flat_map(of).copied().collect() };
        let mut container = Container::new(KIND, header)
            .with("index", blocks.iter().map(|block| block.index).collect())
            .with("rays", blocks.iter().map(|block| block.rays).collect())
            .with("places", blocks.iter().map(|block| block.inside.len() as u32).collect())
            .with("positions", all(|block| &block.positions))
            .with("normals", all(|block| &block.normals))
            .with("inside", blocks.iter().flat_map(|block| &block.inside).copied().collect::<Vec<u8>>())
            .with("halves", blocks.iter().flat_map(|block| block.halves).collect::<Vec<f64>>());
        for (group, name) in GROUPS.iter().enumerate() {
            let light: Vec<f16> = blocks.iter().flat_map(|block| &block.groups[group]).copied().collect();
            let scales: Vec<f32> = blocks.iter().map(|block| block.scales[group]).collect();
            container = container.with(name, light).with(&format!("{name} scale"), scales);
        }
        container.write(path)
    }

    /// Reads a file; any damage is found.
    pub fn read(path: &Path) -> Result<Shard, FileError> {
        let damaged =
            |reason: String| FileError::new(path, reason, "copy it again from where it came, or bake it anew");
        let container = Container::read(path, KIND, MAX_BYTES)?;
        let about = container.header.get("about").cloned().unwrap_or_default();
        let about: ShardAbout =
            serde_json::from_value(about).map_err(|e| damaged(format!("does not say what it is a part of ({e})")))?;
        let directions = directions_of(&about.origin).ok_or_else(|| damaged("has no directions".into()))?;
        let arrays = container.into_arrays().into_iter().collect();
        let blocks = Arrays(arrays)
            .blocks(directions.len())
            .ok_or_else(|| damaged("holds numbers that do not belong together".into()))?;
        let is_own = |block: &Block| block.index < about.blocks;
        if !blocks.iter().all(is_own) || !blocks.is_sorted_by(|a, b| a.index < b.index) {
            return Err(damaged("has blocks in another order than it should".into()));
        }
        Ok(Shard { about, blocks })
    }
}

/// The arrays of a file.
struct Arrays(BTreeMap<String, Array>);

impl Arrays {
    fn take<T: Element>(&mut self, name: &str) -> Option<Vec<T>> {
        T::values(self.0.remove(name)?)
    }

    /// `None` where counts do not agree.
    fn blocks(mut self, directions: usize) -> Option<Vec<Block>> {
        let (index, places) = (self.take::<u32>("index")?, self.take::<u32>("places")?);
        let rays = self.take::<u32>("rays").filter(|rays| rays.len() == index.len())?;
        let (positions, normals) = (self.take::<f32>("positions")?, self.take::<f32>("normals")?);
        let (inside, halves) = (self.take::<u8>("inside")?, self.take::<f64>("halves")?);
        let mut groups = Vec::new();
        for name in GROUPS {
            groups.push((self.take::<f16>(name)?, self.take::<f32>(&format!("{name} scale"))?));
        }
        let total: u64 = places.iter().map(|count| u64::from(*count)).sum();
        let fits = places.len() == index.len()
            && halves.len() == 2 * index.len()
            && inside.len() as u64 == total
            && positions.len() as u64 == 3 * total
            && normals.len() as u64 == 3 * total
            && groups.iter().all(|(_, scales)| scales.len() == index.len());
        if !fits {
            return None;
        }
        let (mut place, mut light) = (0, [0; 3]);
        let mut blocks = Vec::with_capacity(index.len());
        for (i, index) in index.iter().enumerate() {
            let count = places[i] as usize;
            let mut block = Block {
                index: *index,
                positions: positions[3 * place..3 * (place + count)].to_vec(),
                normals: normals[3 * place..3 * (place + count)].to_vec(),
                inside: inside[place..place + count].to_vec(),
                groups: Default::default(),
                scales: [0.0; 3],
                halves: [halves[2 * i], halves[2 * i + 1]],
                rays: rays[i],
            };
            for (group, (all, scales)) in groups.iter().enumerate() {
                block.scales[group] = scales[i];
                if scales[i] > 0.0 {
                    let end = light[group] + 3 * directions * count;
                    block.groups[group] = all.get(light[group]..end)?.to_vec();
                    light[group] = end;
                }
            }
            place += count;
            blocks.push(block);
        }
        groups.iter().zip(light).all(|((all, _), end)| all.len() == end).then_some(blocks)
    }
}

/// The directions that settings ask for.
pub fn directions_of(origin: &Origin) -> Option<Arc<Directions>> {
    super::settings::directions_of_texts(origin.settings.get("spread")?, origin.settings.get("directions")?)
}

/// All blocks of a bake, from shards in any order: the same bytes, however it was shared out. Every fault is told with its file.
pub fn merge(files: &[(PathBuf, Shard)]) -> Result<Bake, Vec<FileError>> {
    let Some((first_path, first)) = files.first() else { return Err(Vec::new()) };
    let mut faults = Vec::new();
    let mut blocks: Vec<(Block, &Path)> = Vec::new();
    for (path, shard) in files {
        let (own, other) = (&first.about, &shard.about);
        if own.origin != other.origin || own.blocks != other.blocks {
            let differing =
                [own.origin.other_parts(&other.origin), own.origin.other_settings(&other.origin)].concat().join(", ");
            let reason = format!("is of another bake than {}: {differing} differ", first_path.display());
            faults.push(FileError::new(
                path,
                reason,
                "leave it out, or bake it of the same scene with the same settings",
            ));
            continue;
        }
        blocks.extend(shard.blocks.iter().map(|block| (block.clone(), path.as_path())));
    }
    blocks.sort_by_key(|(block, _)| block.index);
    for pair in blocks.windows(2).filter(|pair| pair[0].0.index == pair[1].0.index) {
        let reason = format!("has block {}, which {} has too", pair[1].0.index, pair[0].1.display());
        if !faults.iter().any(|fault: &FileError| fault.path == pair[1].1) {
            faults.push(FileError::new(pair[1].1, reason, "leave one of them out"));
        }
    }
    for (path, shard) in files {
        let missing = shard.missing();
        if let Some(some) = missing.first() {
            let [which, of] = shard.about.shard;
            let reason = format!("lacks {} of its blocks, such as {some}: it was not finished", missing.len());
            faults.push(FileError::new(path, reason, format!("go on with `bake --shard {which}/{of}`")));
        }
    }
    if faults.is_empty() {
        let missing: Vec<u32> = (0..first.about.blocks)
            .filter(|index| blocks.binary_search_by_key(index, |(block, _)| block.index).is_err())
            .collect();
        if let Some(some) = missing.first() {
            let [_, of] = first.about.shard;
            let shards: BTreeSet<u32> = missing.iter().map(|block| block % of.max(1) + 1).collect();
            let list = shards.iter().map(|which| format!("{which}/{of}")).collect::<Vec<_>>().join(", ");
            let reason =
                format!("and the others lack {} blocks of {}, such as {some}", missing.len(), first.about.blocks);
            faults.push(FileError::new(first_path, reason, format!("name the shards {list} too")));
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let blocks: Vec<Block> = blocks.into_iter().map(|(block, _)| block).collect();
    whole(&first.about, &blocks).map_err(|reason| vec![FileError::new(first_path, reason, "bake another scene")])
}

/// The bake of all blocks, which are in their order.
pub fn whole(about: &ShardAbout, blocks: &[Block]) -> Result<Bake, String> {
    let directions = directions_of(&about.origin).ok_or("has no directions")?;
    let prepared = assembled(blocks, &directions, about.area).map_err(|e| e.to_string())?;
    Ok(Bake { about: About { origin: about.origin.clone(), noise: noise(blocks), runs: Vec::new() }, prepared })
}
