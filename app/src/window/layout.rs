//! Where the panels are: as at first, shown and put away, kept in the preferences.

use std::collections::BTreeSet;

use eframe::egui;
use egui_tiles::{Container, Linear, LinearDir, Tile, TileId, Tiles, Tree};
use serde_json::Value;

use super::panel::Pane;

/// The viewport in the middle, objects and metals left, the material right.
pub fn initial() -> Tree<Pane> {
    let mut tiles = Tiles::default();
    let mut tabs = |panes: &[Pane]| {
        let children = panes.iter().map(|pane| tiles.insert_pane(*pane)).collect();
        tiles.insert_tab_tile(children)
    };
    let (objects, metals) = (tabs(&[Pane::Scene, Pane::History]), tabs(&[Pane::Presets]));
    let picture = tabs(&[Pane::Viewport]);
    let (material, plot) = (
        tabs(&[Pane::Material, Pane::Lights, Pane::Environment, Pane::Compare, Pane::Chart]),
        tabs(&[Pane::Reflectance, Pane::Scope]),
    );
    let mut column = |upper, lower, share: f32| {
        let mut linear = Linear::new(LinearDir::Vertical, vec![upper, lower]);
        linear.shares.set_share(upper, share);
        tiles.insert_container(Container::Linear(linear))
    };
    let (left, right) = (column(objects, metals, 0.6), column(material, plot, 2.2));
    let mut row = Linear::new(LinearDir::Horizontal, vec![left, picture, right]);
    row.shares.set_share(left, 0.5);
    row.shares.set_share(picture, 1.5);
    row.shares.set_share(right, 0.6);
    let root = tiles.insert_container(Container::Linear(row));
    Tree::new(egui::Id::unique("layout"), root, tiles)
}

/// The panel is seen: neither put away nor behind another tab.
pub fn is_shown(tree: &Tree<Pane>, pane: Pane) -> bool {
    tree.tiles.find_pane(&pane).is_some_and(|tile| tree.active_tiles().contains(&tile))
}

/// Shows a panel, before the other tabs of its place.
pub fn show(tree: &mut Tree<Pane>, pane: Pane) {
    let Some(tile) = tree.tiles.find_pane(&pane) else { return };
    let mut above = Some(tile);
    while let Some(id) = above {
        tree.set_visible(id, true);
        above = tree.tiles.parent_of(id);
    }
    tree.make_active(|id, _| id == tile);
}

/// Shows a panel that is not seen and puts away one that is.
pub fn toggle(tree: &mut Tree<Pane>, pane: Pane) {
    match tree.tiles.find_pane(&pane) {
        Some(tile) if is_shown(tree, pane) => tree.set_visible(tile, false),
        _ => show(tree, pane),
    }
}

/// The layout as it is kept.
pub fn store(tree: &Tree<Pane>) -> Option<Value> {
    serde_json::to_value(tree).ok()
}

/// A layout that was kept; `None` where it cannot be used, such as one with a panel that is no more.
pub fn restore(stored: &Value) -> Option<Tree<Pane>> {
    let mut tree: Tree<Pane> = serde_json::from_value(stored.clone()).ok()?;
    let (mut seen, mut panes) = (BTreeSet::new(), Vec::new());
    visit(&tree.tiles, tree.root()?, &mut seen, &mut panes)?;
    let twice = panes.iter().enumerate().any(|(index, pane)| panes[..index].contains(pane));
    if twice || seen.len() != tree.tiles.len() {
        return None;
    }
    // A layout of an older version lacks the newer panels: they join the first tabs.
    for pane in Pane::ALL.into_iter().filter(|pane| !panes.contains(pane)) {
        let first_tabs = tree.tiles.iter().find_map(|(id, tile)| match tile {
            Tile::Container(Container::Tabs(_)) => Some(*id),
            _ => None,
        })?;
        let tile = tree.tiles.insert_pane(pane);
        tree.move_tile_to_container(tile, first_tabs, usize::MAX, true);
    }
    Some(tree)
}

/// Collects what hangs on a tile; `None` where a tile is missing or hangs in two places.
fn visit(tiles: &Tiles<Pane>, id: TileId, seen: &mut BTreeSet<u64>, panes: &mut Vec<Pane>) -> Option<()> {
    if !seen.insert(id.0) {
        return None;
    }
    match tiles.get(id)? {
        Tile::Pane(pane) => panes.push(*pane),
        Tile::Container(container) => {
            for child in container.children() {
                visit(tiles, *child, seen, panes)?;
            }
        }
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_panel_has_a_place_at_first_and_can_be_put_away_and_shown() {
        for pane in Pane::ALL {
            let mut tree = initial();
            show(&mut tree, pane);
            assert!(is_shown(&tree, pane), "{pane:?}");
            toggle(&mut tree, pane);
            assert!(!is_shown(&tree, pane), "{pane:?}");
            toggle(&mut tree, pane);
            assert!(is_shown(&tree, pane), "{pane:?}");
        }
    }

    #[test]
    fn a_layout_is_restored_as_it_was_kept() {
        let mut tree = initial();
        toggle(&mut tree, Pane::Reflectance);
        let restored = restore(&store(&tree).unwrap()).unwrap();
        assert_eq!(restored, tree);
        assert!(!is_shown(&restored, Pane::Reflectance));
    }

    #[test]
    fn a_layout_that_makes_no_sense_is_refused() {
        let sound = store(&initial()).unwrap();
        assert!(restore(&Value::Null).is_none());
        let broken = |from: &str, to: &str| {
            let text = sound.to_string();
            assert!(text.contains(from), "{text}");
            serde_json::from_str(&text.replacen(from, to, 1)).unwrap()
        };
        assert!(restore(&broken("\"Presets\"", "\"Nothing\"")).is_none());
        assert!(restore(&broken("\"Presets\"", "\"Scene\"")).is_none(), "twice the same");
        let mut dangling = sound.clone();
        dangling["root"] = 4711.into();
        assert!(restore(&dangling).is_none());
        let mut circle = sound.clone();
        let root = circle["root"].clone();
        for tile in circle["tiles"]["tiles"].as_object_mut().unwrap().values_mut() {
            if let Some(children) = tile.pointer_mut("/Container/Tabs/children") {
                *children = serde_json::json!([root]);
            }
        }
        assert!(restore(&circle).is_none(), "a circle");
    }

    #[test]
    fn a_panel_that_an_older_layout_lacks_is_added() {
        let mut tree = initial();
        let history = tree.tiles.find_pane(&Pane::History).unwrap();
        tree.remove_recursively(history);
        let restored = restore(&store(&tree).unwrap()).unwrap();
        assert!(restored.tiles.find_pane(&Pane::History).is_some());
    }
}
