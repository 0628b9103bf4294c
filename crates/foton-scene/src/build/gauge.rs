//! How a scene is built: who may stop that, and who is told how far it is.

use std::sync::atomic::{AtomicUsize, Ordering};

use foton_math::{Cancel, Cancelled};

use crate::census::Census;

/// What building is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BuildStep {
    /// Bringing shapes into scene units.
    Shapes,
    /// Making the tree that rays go through.
    Tree,
    /// Finding what continues each other.
    Patches,
    /// Finding surfaces that lie in one another.
    Coincidences,
}

impl BuildStep {
    /// What goes on, for a person.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Shapes => "placing shapes",
            Self::Tree => "building the tree",
            Self::Patches => "joining surfaces",
            Self::Coincidences => "looking for surfaces that lie in one another",
        }
    }
}

/// Is told what building is at and which share of that is done, from any thread.
pub type Tell<'a> = dyn Fn(BuildStep, f64) + Sync + 'a;

/// Whether shapes that share a mesh share a tree over it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Instancing {
    /// Where that saves much memory and time: rays are a little slower.
    #[default]
    Worthwhile,
    /// Never.
    Never,
    /// Wherever two do.
    Always,
}

/// How a scene is built.
#[derive(Clone, Default)]
pub struct BuildOptions<'a> {
    /// What is modelled even if the scene has none of it: its picture is the same, but takes more work and memory. For tests and
    /// measurements of what leaving things out saves.
    pub forced: Census,
    /// Whether shapes that share a mesh share a tree: the picture is the same.
    pub instancing: Instancing,
    /// Ends the build within a fraction of a second.
    pub cancel: Cancel,
    /// Who is told how far it is.
    pub tell: Option<&'a Tell<'a>>,
}

impl BuildOptions<'_> {
    /// Begins a step of so many items.
    pub(crate) fn step(&self, step: BuildStep, items: usize) -> Gauge<'_> {
        if let Some(tell) = self.tell {
            tell(step, 0.0);
        }
        Gauge { options: self, step, done: AtomicUsize::new(0), items }
    }
}

/// How far a step of a build is. Threads share it.
pub(crate) struct Gauge<'a> {
    options: &'a BuildOptions<'a>,
    step: BuildStep,
    done: AtomicUsize,
    items: usize,
}

impl Gauge<'_> {
    /// Items at the most between two questions.
    pub(crate) const EVERY: usize = Cancel::EVERY;

    /// Whether the build goes on. To be asked often, where items may take long.
    pub(crate) fn check(&self) -> Result<(), Cancelled> {
        self.options.cancel.check()
    }

    /// Asks whether the build goes on once in [`Gauge::EVERY`] items of a loop; `number` is that of the item.
    #[inline]
    pub(crate) fn check_at(&self, number: usize) -> Result<(), Cancelled> {
        self.options.cancel.check_at(number)
    }

    /// Notes the item of that number in a loop, and asks once in [`Gauge::EVERY`] whether the build goes on.
    #[inline]
    pub(crate) fn item(&self, number: usize) -> Result<(), Cancelled> {
        if number.is_multiple_of(Self::EVERY) { self.add(Self::EVERY) } else { Ok(()) }
    }

    /// Notes that so many items more are done, and asks whether the build goes on.
    pub(crate) fn add(&self, items: usize) -> Result<(), Cancelled> {
        self.check()?;
        let done = self.done.fetch_add(items, Ordering::Relaxed) + items;
        if let Some(tell) = self.options.tell {
            tell(self.step, (done as f64 / self.items.max(1) as f64).min(1.0));
        }
        Ok(())
    }
}
