//! Two pictures of the same view held against each other: sides A and B, or the live picture and the reference.
//!
//! What the sides are is stored in the document; how they are shown is not. While nothing is compared nothing is kept.

mod map;
mod sides;

use std::sync::Arc;

use burnish_core::document::Side;
use burnish_core::lighting::Store;
use burnish_core::lighting::probe::Raster;
use burnish_core::measure::error_map::Metric;
use eframe::egui;

use super::preparations::{Preparations, drawn_on_device};
use super::reference::Reference;
use super::session::Session;
use super::stage::{Screen, Stage};

pub use map::{Legend, MapDesk, Pictures, Source, value_at};
pub use sides::{SideScene, Sides};

/// How two pictures are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CompareView {
    /// A left of a line, B right of it.
    Wipe,
    /// Each in its half.
    SideBySide,
    /// Where B differs from A.
    Difference,
    /// Where the live picture differs from the reference.
    Error,
}

impl CompareView {
    /// All of them.
    pub const ALL: [CompareView; 4] =
        [CompareView::Wipe, CompareView::SideBySide, CompareView::Difference, CompareView::Error];

    /// Sides A and B are shown.
    pub fn has_sides(self) -> bool {
        self != CompareView::Error
    }

    /// It lays a map over the picture.
    pub fn has_map(self) -> bool {
        matches!(self, CompareView::Difference | CompareView::Error)
    }
}

/// The comparison.
pub struct Compare {
    view: Option<CompareView>,
    /// The last view of two sides, for the switch that has one button for all of them.
    last: CompareView,
    /// Place of the line, 0 to 1 from the left.
    pub wipe: f32,
    /// What maps measure.
    pub metric: Metric,
    /// The scenes of the sides.
    pub sides: Sides,
    /// What the sides look up where the processor draws them.
    pub preparations: [Preparations; 2],
    /// Their methods draw on the processor.
    on_processor: [bool; 2],
    /// Until they are prepared classical light stands in.
    stands_in: [bool; 2],
    /// Draws B on the processor where A is drawn there too.
    second: Reference,
    /// Maps and the pictures that they are made of.
    pub maps: MapDesk,
    /// Revision of the document when the sides were drawn last, and whether nothing is left to draw.
    revision: u64,
    settled: [bool; 2],
    turn: Side,
}

impl Compare {
    /// Nothing is compared; preparations are kept in a store.
    pub fn new(store: Store) -> Compare {
        Compare {
            // A side has no badge that says stale.
            preparations: [store.clone(), store].map(|store| Preparations::new(store).always_anew()),
            on_processor: [false; 2],
            stands_in: [false; 2],
            view: None,
            last: CompareView::Wipe,
            wipe: 0.5,
            metric: Metric::default(),
            sides: Sides::default(),
            second: Reference::default(),
            maps: MapDesk::default(),
            revision: 0,
            settled: [false; 2],
            turn: Side::A,
        }
    }

    /// How two pictures are shown; `None` while there is one.
    pub fn view(&self) -> Option<CompareView> {
        self.view
    }

    /// The last view of two sides.
    pub fn last(&self) -> CompareView {
        self.last
    }

    /// Goes over to a view, or back to one picture.
    pub fn show(&mut self, view: Option<CompareView>) {
        self.view = view;
        if let Some(view) = view.filter(|view| view.has_sides()) {
            self.last = view;
        }
        self.settled = [false; 2];
    }

    /// Notes what lights a side.
    pub fn light(&mut self, side: Side, scene: &SideScene, raster: Option<Arc<dyn Raster>>, ctx: &egui::Context) {
        self.on_processor[side as usize] = !drawn_on_device(&scene.layers);
        self.preparations[side as usize].draw_probes_by(raster);
        self.preparations[side as usize].follow(&scene.layers, &scene.scene, ctx);
    }

    /// The processor draws a side, path by path or point by point.
    pub fn is_traced(&self, session: &Session, side: Side) -> bool {
        session.document().compare.side(side).is_reference() || self.on_processor[side as usize]
    }

    /// Notes whether classical light stands in for a side that is traced.
    pub fn stand_in(&mut self, side: Side, stands_in: bool) {
        self.stands_in[side as usize] = stands_in;
    }

    /// The picture of a side is one that its tracer made.
    pub fn is_refined(&self, session: &Session, side: Side) -> bool {
        self.is_traced(session, side) && !self.stands_in[side as usize]
    }

    /// Another document is compared: nothing of the last one is shown.
    pub fn forget(&mut self) {
        self.preparations.iter_mut().for_each(Preparations::forget);
        self.maps.forget();
    }

    /// B has the second tracer where A is drawn on the processor as well.
    fn is_second(&self, session: &Session, side: Side) -> bool {
        side == Side::B && Side::ALL.iter().all(|side| self.is_traced(session, *side))
    }

    /// The thread that draws a side: the window's, or a second one.
    pub fn tracer<'a>(&'a mut self, main: &'a mut Reference, session: &Session, side: Side) -> &'a mut Reference {
        if self.is_second(session, side) { &mut self.second } else { main }
    }

    /// Draws the live picture on the processor while the window's own thread traces its reference.
    pub fn second(&mut self) -> &mut Reference {
        &mut self.second
    }

    /// The same, to look at.
    pub fn tracer_of<'a>(&'a self, main: &'a Reference, session: &Session, side: Side) -> &'a Reference {
        if self.is_second(session, side) { &self.second } else { main }
    }

    /// The screen of a side: one that is drawn live has the main one, so that one alone needs no second.
    pub fn screen(&self, session: &Session, side: Side) -> Screen {
        let live = |side| !self.is_traced(session, side);
        match (side, live(side), live(side.other())) {
            (_, true, false) => Screen::Main,
            (_, false, true) => Screen::Second,
            (Side::A, ..) => Screen::Main,
            (Side::B, ..) => Screen::Second,
        }
    }

    /// Which side may sharpen in this frame: two that are drawn live take turns.
    pub fn turn(&mut self, session: &Session) -> [bool; 2] {
        if self.revision != session.revision {
            self.revision = session.revision;
            self.settled = [false; 2];
            self.maps.forget();
        }
        let both = Side::ALL.iter().all(|side| !self.is_traced(session, *side));
        if !both || self.settled == [true; 2] {
            return [true; 2];
        }
        self.turn = self.turn.other();
        // One that is sharp leaves its turns to the other.
        if self.settled[self.turn as usize] {
            self.turn = self.turn.other();
        }
        Side::ALL.map(|side| side == self.turn)
    }

    /// Notes whether a side is sharp, after it had its turn.
    pub fn note(&mut self, side: Side, settled: bool) {
        self.settled[side as usize] = settled;
    }

    /// Both are as sharp as they get.
    pub fn is_settled(&self) -> bool {
        self.settled == [true; 2]
    }

    /// A side is as sharp as it gets.
    pub fn is_side_settled(&self, side: Side) -> bool {
        self.settled[side as usize]
    }

    /// Someone uses mouse or keyboard.
    pub fn note_input(&self) {
        self.second.note_input();
    }

    /// Another thread computes a map.
    pub fn is_busy(&self) -> bool {
        self.maps.is_busy() || self.preparations.iter().any(Preparations::is_busy)
    }

    /// Ends a frame of the window: what nobody looks at is given back.
    pub fn end_frame(&mut self, stage: &mut Stage) {
        self.second.end_frame();
        self.sides.end_frame();
        if !self.view.is_some_and(CompareView::has_sides) {
            stage.close_second();
            self.preparations.iter_mut().for_each(Preparations::forget);
        }
        if !self.view.is_some_and(CompareView::has_map) {
            self.maps = MapDesk::default();
        }
    }
}
