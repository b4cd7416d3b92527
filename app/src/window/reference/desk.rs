//! What lies between the window and the thread that traces: the newest order on one side, the newest picture on the other.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use burnish_core::reference::Control;

use super::{Look, Subject};

/// How long nothing is traced after input.
pub const QUIET: Duration = Duration::from_millis(300);
/// How long tracing goes on although nobody takes its pictures: a window that is hidden draws no frames.
const UNSEEN: Duration = Duration::from_secs(2);

/// What the thread is at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Activity {
    /// Nothing.
    #[default]
    Idle,
    /// Makes the scene ready.
    Preparing,
    /// Follows paths.
    Tracing,
}

/// The desk. Every call is short, whatever the thread does.
#[derive(Default)]
pub struct Desk {
    papers: Mutex<Papers>,
    changed: Condvar,
}

#[derive(Default)]
struct Papers {
    /// Counts subjects.
    number: u64,
    subject: Option<Arc<Subject>>,
    /// Someone looks.
    open: bool,
    quit: bool,
    rest_end: Option<Instant>,
    /// Sum of all rests.
    rested: Duration,
    /// Ends or rests what runs.
    control: Control,
    /// There is a trial of a failure.
    trial: bool,
    activity: Activity,
    /// With the number of its subject.
    look: Option<(u64, Look)>,
    fault: Option<(u64, String)>,
    /// Why there is no thread.
    broken: Option<String>,
    /// Since when a picture lies here that was not taken.
    unseen: Option<Instant>,
}

/// What the window takes from the desk.
pub struct Taken {
    pub look: Option<Look>,
    pub fault: Option<String>,
    pub activity: Activity,
}

/// A step of work.
pub struct Order {
    /// Number of the subject.
    pub number: u64,
    pub subject: Arc<Subject>,
    pub control: Control,
    /// Fail, for trial.
    pub trial: bool,
    /// See [`Desk::rested`].
    pub rested: Duration,
}

/// The window's side.
impl Desk {
    fn papers(&self) -> MutexGuard<'_, Papers> {
        // Nothing here is left half done by a panic.
        self.papers.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Wants this subject traced, and takes what there is of it.
    pub fn order(&self, subject: Subject) -> Taken {
        let mut papers = self.papers();
        if !papers.subject.as_ref().is_some_and(|old| old.is_like(&subject)) {
            papers.number += 1;
            papers.subject = Some(Arc::new(subject));
            papers.control.cancel();
            (papers.look, papers.fault) = (None, None);
        }
        papers.open = true;
        papers.unseen = None;
        self.changed.notify_all();
        let number = papers.number;
        let fault = papers.fault.as_ref().filter(|(of, _)| *of == number).map(|(_, fault)| fault);
        let fault = fault.or(papers.broken.as_ref()).cloned();
        let look = papers.look.as_ref().filter(|(of, _)| *of == number).map(|(_, look)| look.clone());
        Taken { look, fault, activity: papers.activity }
    }

    /// Nobody looks: a pass that is not whole is lost, those before are kept.
    pub fn close(&self) {
        let mut papers = self.papers();
        if std::mem::take(&mut papers.open) {
            papers.control.cancel();
        }
    }

    /// Nothing is traced for a while.
    pub fn rest(&self) {
        let mut papers = self.papers();
        let now = Instant::now();
        let end = now + QUIET;
        let begin = papers.rest_end.map_or(now, |old| old.max(now));
        papers.rested += end.saturating_duration_since(begin);
        papers.rest_end = Some(end);
        papers.control.rest_until(end);
    }

    pub fn rest_end(&self) -> Option<Instant> {
        self.papers().rest_end
    }

    pub fn is_tracing(&self) -> bool {
        self.papers().activity != Activity::Idle
    }

    pub fn inject_failure(&self) {
        self.papers().trial = true;
    }

    /// There is no thread, for this reason.
    pub fn give_up(&self, reason: String) {
        self.papers().broken = Some(reason);
    }

    /// Ends the thread.
    pub fn quit(&self) {
        let mut papers = self.papers();
        papers.quit = true;
        papers.control.cancel();
        self.changed.notify_all();
    }
}

/// The thread's side.
impl Desk {
    /// Waits for a subject other than `done` that someone looks at, and for the end of a rest; `None` at the end.
    pub fn next(&self, done: Option<u64>) -> Option<Order> {
        let mut papers = self.papers();
        loop {
            if papers.quit {
                return None;
            }
            let seen = papers.unseen.is_none_or(|since| since.elapsed() < UNSEEN);
            let wanted = papers.open && seen && done != Some(papers.number);
            let rest = papers.rest_end.and_then(|end| end.checked_duration_since(Instant::now()));
            papers = match (papers.subject.clone().filter(|_| wanted), rest) {
                (Some(subject), None) => {
                    papers.control = Control::default();
                    return Some(Order {
                        number: papers.number,
                        subject,
                        control: papers.control.clone(),
                        trial: std::mem::take(&mut papers.trial),
                        rested: papers.rested,
                    });
                }
                (Some(_), Some(left)) => {
                    papers.activity = Activity::Idle;
                    let waited = self.changed.wait_timeout(papers, left);
                    waited.unwrap_or_else(PoisonError::into_inner).0
                }
                (None, _) => {
                    papers.activity = Activity::Idle;
                    self.changed.wait(papers).unwrap_or_else(PoisonError::into_inner)
                }
            };
        }
    }

    pub fn set_activity(&self, activity: Activity) {
        self.papers().activity = activity;
    }

    /// How long input has let the thread rest so far, with what is left of the last rest.
    pub fn rested(&self) -> Duration {
        self.papers().rested
    }

    /// Puts a picture on the desk; one of a former subject is thrown away.
    pub fn publish(&self, number: u64, look: Look) {
        let mut papers = self.papers();
        if papers.number == number {
            papers.look = Some((number, look));
            papers.unseen.get_or_insert_with(Instant::now);
        }
    }

    /// There will be no picture of a subject.
    pub fn fail(&self, number: u64, reason: String) {
        self.papers().fault = Some((number, reason));
    }
}
