//! The picture of a scene at rest: jittered frames at full resolution, summed a part at a time.

use burnish_core::lighting::classical::FrameSettings;
use burnish_core::scene::Camera;

use super::Canvas;
use super::pace::Pace;
use crate::error::RenderError;
use crate::frame::{Encoding, Jitter};
use crate::pass::accumulate::Sums;
use crate::passes::Passes;
use crate::probes::ProbeLook;
use crate::resident::Resident;

/// Frames that are averaged. The picture is settled after them.
pub(crate) const FRAMES: u32 = 16;

/// Frames over which a picture fades into one that is lit otherwise.
const FADE: u32 = 8;

/// Sums and how far they are.
pub(crate) struct Still {
    sums: Sums,
    /// Whole frames in what is shown; after a restart still those of the picture before.
    pub frames: u32,
    /// The sum of a picture that fades out, with its frames.
    before: Option<(wgpu::Texture, u32)>,
    /// Whole frames since the restart.
    done: u32,
    current: Option<Current>,
}

/// The frame that is being drawn.
struct Current {
    encoding: Encoding,
    /// Rows that are lit.
    rows: u32,
}

/// The frame that is drawn as the `n`th: any few at the start are spread over the pixel, the first near its middle.
fn order(n: u32) -> u32 {
    const { assert!(FRAMES == 16) };
    (n.reverse_bits() >> 28) ^ 9
}

impl Still {
    pub fn new(passes: &Passes, canvas: &Canvas) -> Still {
        Still { sums: Sums::new(&passes.gpu, canvas.targets.size), frames: 0, before: None, done: 0, current: None }
    }

    /// Starts anew. The sums stay what they are until the first frame is whole.
    pub fn restart(&mut self) {
        if let Some((sum, frames)) = self.before.take().filter(|_| self.done == 0) {
            // Nothing has come after it yet: it is what is shown.
            self.sums.put(sum);
            self.frames = frames;
        }
        self.done = 0;
        self.current = None;
    }

    /// Starts anew with the same view of the same surfaces: the picture fades into the next.
    pub fn replace(&mut self, passes: &Passes) {
        let before = match self.before.take() {
            // It is most of what is shown.
            Some(before) if 2 * self.done < FADE => Some(before),
            // Without a frame since a restart there is only a picture from elsewhere.
            _ => (self.done > 0).then(|| (self.sums.take(&passes.gpu), self.frames)),
        };
        self.restart();
        self.before = before;
    }

    /// The sum that is shown, and its frames.
    pub fn sum(&self) -> (&wgpu::Texture, u32) {
        match &self.before {
            Some((sum, frames)) if self.done == 0 => (sum, *frames),
            _ => (self.sums.texture(), self.frames),
        }
    }

    /// What fades out beside [`Still::sum`]: sum, frames and weight.
    pub fn fading(&self) -> Option<(&wgpu::Texture, u32, f32)> {
        let (sum, frames) = self.before.as_ref().filter(|_| (1..FADE).contains(&self.done))?;
        Some((sum, *frames, 1.0 - self.done as f32 / FADE as f32))
    }

    /// There is a whole frame of the present scene.
    pub fn begun(&self) -> bool {
        self.done > 0
    }

    pub fn settled(&self) -> bool {
        self.done >= FRAMES
    }

    /// Draws on until a frame is whole or the time is up.
    pub fn advance(
        &mut self,
        passes: &Passes,
        resident: &Resident,
        canvas: &Canvas,
        (camera, settings): (&Camera, (&FrameSettings, &ProbeLook)),
        pace: &mut Pace,
    ) -> Result<(), RenderError> {
        let (gpu, targets) = (&passes.gpu, &canvas.targets);
        let mut spent = 0.0;
        let Current { encoding, rows } = match &mut self.current {
            Some(current) => current,
            None => {
                let jitter = Jitter { frame: order(self.done), frames: FRAMES };
                let encoding = Encoding::new(passes, resident, camera, targets.size, settings, jitter);
                let ms = super::timed(gpu, |encoder| encoding.surfaces(passes, encoder, resident, targets))?;
                pace.note_surfaces(ms);
                spent += ms;
                self.current.insert(Current { encoding, rows: 0 })
            }
        };
        while *rows < targets.size.y {
            let next = pace.rows(spent, targets.size, targets.size.y - *rows);
            if next == 0 {
                return Ok(());
            }
            let ms = super::timed(gpu, |encoder| {
                encoding.light(passes, encoder, resident, targets, *rows..*rows + next);
            })?;
            pace.note_rows(targets.size, next, ms);
            spent += ms;
            *rows += next;
        }
        super::timed(gpu, |encoder| {
            encoding.blend(passes, encoder, resident, targets);
            if self.done == 0 {
                self.sums.clear(encoder);
            }
            passes.accumulate.encode(gpu, encoder, &targets.frame, &mut self.sums);
        })?;
        self.done += 1;
        self.frames = self.done;
        self.current = None;
        if self.done >= FADE {
            self.before = None;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_frame_is_drawn_once() {
        let mut drawn: Vec<_> = (0..FRAMES).map(order).collect();
        drawn.sort_unstable();
        assert_eq!(drawn, (0..FRAMES).collect::<Vec<_>>());
    }
}
