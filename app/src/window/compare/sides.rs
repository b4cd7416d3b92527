//! The scenes of the two sides.

use std::sync::Arc;

use burnish_core::document::{Curves, Document, Side, Snapshot, resolve};
use burnish_core::lighting::Layers;
use burnish_core::scene::Scene;

use crate::window::session::Session;

/// What a side shows.
#[derive(Clone, Debug)]
pub struct SideScene {
    /// The document in the state of the side, its own point of view included.
    pub document: Arc<Document>,
    /// What is drawn.
    pub scene: Arc<Scene>,
    /// What lights it.
    pub layers: Layers,
    /// Files that are missing there.
    pub missing: usize,
}

/// The scenes of snapshots that were resolved; those of the document as it is now are the session's.
#[derive(Default)]
pub struct Sides {
    kept: [Option<Kept>; 2],
    used: bool,
    curves: Curves,
}

struct Kept {
    snapshot: Arc<Snapshot>,
    model: String,
    files: u64,
    shown: SideScene,
}

impl Sides {
    /// What a side shows. Resolved once, as long as snapshot and files stay the same.
    pub fn get(&mut self, session: &Session, side: Side) -> SideScene {
        self.used = true;
        let now = session.document();
        let Some(snapshot) = now.snapshot_of(side) else {
            let missing = session.resolved().missing.len();
            let (document, scene, layers) = (now.clone(), session.scene().clone(), session.layers().clone());
            return SideScene { document, scene, layers, missing };
        };
        let kept = &mut self.kept[side as usize];
        let fits = |kept: &&mut Kept| {
            Arc::ptr_eq(&kept.snapshot, snapshot) && kept.files == session.files_revision && kept.model == now.scene
        };
        if let Some(kept) = kept.as_mut().filter(fits) {
            return kept.shown.clone();
        }
        let mut document = now.of_side(side);
        // The model may have got materials since.
        if let Some(model) = session.sources().models.get(&now.scene) {
            document.sync(model);
        }
        let resolved = resolve(&document, session.sources(), &mut self.curves);
        let shown = SideScene {
            layers: document.lighting.layers(&resolved.object_keys),
            document: Arc::new(document),
            scene: resolved.scene,
            missing: resolved.missing.len(),
        };
        let (files, model) = (session.files_revision, now.scene.clone());
        *kept = Some(Kept { snapshot: snapshot.clone(), model, files, shown: shown.clone() });
        shown
    }

    /// Ends a frame of the window: scenes that nobody asked for are forgotten.
    pub fn end_frame(&mut self) {
        if !std::mem::take(&mut self.used) {
            *self = Sides::default();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use burnish_core::document;
    use burnish_core::param::ParamValue;

    #[test]
    fn the_scene_of_a_snapshot_is_made_once_and_stays_as_the_document_goes_on() {
        let mut session = Session::new(document::open("gallery:workbench").unwrap(), None);
        let mut sides = Sides::default();
        assert!(Arc::ptr_eq(&sides.get(&session, Side::A).scene, session.scene()));
        session.edit("Store as A", "", |document| document.store_side(Side::A));
        let first = sides.get(&session, Side::A);
        session.edit("Roughness", "", |document| document.set_value(0, "roughness", ParamValue::Number(0.9)).unwrap());
        session.edit("Camera", "", |document| document.view.camera.orbit(10.0, 0.0));
        let again = sides.get(&session, Side::A);
        assert!(Arc::ptr_eq(&first.scene, &again.scene));
        assert_ne!(again.scene.materials[0].roughness, session.scene().materials[0].roughness);
        assert!(Arc::ptr_eq(&again.scene.meshes[0], &session.scene().meshes[0]), "meshes are shared");
        assert!(Arc::ptr_eq(&sides.get(&session, Side::B).scene, session.scene()));
        sides.end_frame();
        sides.end_frame();
        assert!(sides.kept.iter().all(Option::is_none), "nobody asked");
    }
}
