//! Names that stay when a model is saved again: how documents refer to its parts.

use std::collections::{BTreeMap, BTreeSet};

use crate::scene::Scene;

/// A key for each name, in order: the name itself, or `name #2` from its second occurrence on.
fn keys<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let names: Vec<&str> = names.collect();
    // A part may already be called `name #2`.
    let mut taken: BTreeSet<String> = names.iter().map(|name| name.to_string()).collect();
    let mut seen: BTreeMap<&str, usize> = BTreeMap::new();
    let mut key = |name: &str, count: usize| {
        if count == 1 {
            return name.to_string();
        }
        let mut number = count;
        loop {
            let key = format!("{name} #{number}");
            if taken.insert(key.clone()) {
                return key;
            }
            number += 1;
        }
    };
    names
        .into_iter()
        .map(|name| {
            let count = seen.entry(name).or_insert(0);
            *count += 1;
            key(name, *count)
        })
        .collect()
}

/// Keys of the instances of a scene.
pub fn object_keys(scene: &Scene) -> Vec<String> {
    keys(scene.instances.iter().map(|instance| instance.name.as_str()))
}

/// Keys of the materials of a scene.
pub fn material_keys(scene: &Scene) -> Vec<String> {
    keys(scene.materials.iter().map(|material| material.name.as_str()))
}

#[cfg(test)]
mod tests {
    use super::keys;

    #[test]
    fn keys_are_unique_and_names_where_they_can_be() {
        let made = keys(["a", "b", "a", "a #2", "a", ""].into_iter());
        assert_eq!(made, ["a", "b", "a #3", "a #2", "a #4", ""]);
        assert_eq!(keys(["a", "a"].into_iter()), ["a", "a #2"]);
    }
}
