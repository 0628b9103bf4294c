//! Cutting cells by what a training pass has noted.
//!
//! With the probability p of a cell, its volume V, the integral I = ∫ F² of the squared worth F over it and the mean cost c of a photon
//! that starts there, the noise times the cost of a pass is least for p ∝ √(I V / c), where it is (Σ √(I V c))². Cells are cut
//! where that sum falls most, by more than chance would make it seem. What few samples say is drawn towards the cell that was
//! cut, and part of all photons starts as without guidance: no photon's power is more than 1/[`DEFENSIVE_SHARE`] of that.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::ops::Range;

use foton_scene::{PRIMARY_NUMBERS, Sources};

use super::cells::{Cell, Cells, MAX_CUTS};
use super::samples::{Sample, Samples};

/// This share of all photons starts as without guidance.
pub(super) const DEFENSIVE_SHARE: f64 = 0.3;

/// Where a cell may be cut: at multiples of this share of its length.
const BINS: usize = 8;

/// As if so many samples had been found besides, evenly: what has found none is not worthless. Few, since √(I V) of a large cell is much
/// for the smallest I, and the defensive share looks after what is unknown.
const PRIOR: f64 = 0.5;

/// As if so many photons had started besides, of the mean worth and cost.
const PRIOR_OF_WHOLE: f64 = 16.0;

/// Chance makes a cut of a cell that needs none gain about 1/8n for n samples; the best of many cuts must gain more than 2/n.
const SIGNIFICANT: f64 = 2.0;

/// No edge of a cell is shorter.
const SHORTEST: f32 = 1.0 / (1 << 16) as f32;

/// A cell that may be cut further.
struct Node {
    cell: Cell,
    samples: Range<usize>,
    /// ∫ F² over it, as far as samples and the cells that it was cut from are believed.
    squares: f64,
    cost: f64,
    cut: Option<Cut>,
}

/// The best cut of a cell.
#[derive(Clone, Copy)]
struct Cut {
    axis: usize,
    at: f32,
    /// Share of the cell's ∫ F² below.
    squares: f64,
    /// By how much Σ √(I V c) falls.
    gain: f64,
}

/// What a cell would gain, to find the largest; of equals the one that was made first.
struct Candidate {
    gain: f64,
    node: usize,
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.gain.total_cmp(&other.gain).then(other.node.cmp(&self.node))
    }
}

/// Sums over the samples of a cell.
#[derive(Clone, Copy, Default)]
struct Sums {
    count: f64,
    cost: f64,
    squares: f64,
    fourth_powers: f64,
}

impl Sums {
    fn add(&mut self, sample: &Sample) {
        let squares = sample.squares();
        self.count += 1.0;
        self.cost += f64::from(sample.cost);
        self.squares += squares;
        self.fourth_powers += squares * squares;
    }

    /// How many equal samples would say as much.
    fn effective(&self) -> f64 {
        if self.fourth_powers > 0.0 { self.squares * self.squares / self.fourth_powers } else { 0.0 }
    }

    /// The mean cost of a photon, where `prior` was expected.
    fn mean_cost(&self, prior: f64) -> f64 {
        (self.cost + PRIOR_OF_WHOLE * prior) / (self.count + PRIOR_OF_WHOLE)
    }
}

impl Sample {
    /// Its addend to the estimate of ∫ F² with F at density 1: power was divided by the density, and so is its square once more.
    fn squares(&self) -> f64 {
        self.density * self.worth
    }
}

/// Cells by what a training pass has noted; sorts the samples on the way. Those of no guidance where it has noted no worth.
#[must_use]
pub fn grow(samples: &mut Samples, sources: &Sources) -> Cells {
    let noted = &mut samples.noted;
    // Values that are no numbers say nothing.
    noted.retain(|s| s.squares().is_finite() && s.squares() * s.squares() < f64::MAX);
    let mut nodes = whole_emitters(noted, sources);
    if nodes.is_empty() || nodes.iter().all(|node| node.squares <= 0.0) {
        return Cells::unguided(sources);
    }
    let uses: Vec<_> = nodes.iter().map(|node| sources.uses(node.cell.emitter as usize)).collect();
    let uses_of = |cell: &Cell, nodes: &[Node]| {
        let root = nodes[..uses.len()].binary_search_by_key(&cell.emitter, |node| node.cell.emitter);
        root.map_or([false; PRIMARY_NUMBERS], |i| uses[i])
    };
    let mut heap = BinaryHeap::new();
    for i in 0..nodes.len() {
        let axes = uses_of(&nodes[i].cell, &nodes);
        nodes[i].cut = best_cut(&nodes[i], noted, axes);
        heap.extend(nodes[i].cut.map(|cut| Candidate { gain: cut.gain, node: i }));
    }
    for _ in 0..MAX_CUTS {
        let Some(Candidate { node, .. }) = heap.pop() else { break };
        let Some(above) = divide(&mut nodes[node], noted) else { continue };
        let axes = uses_of(&above.cell, &nodes);
        nodes.push(above);
        for i in [node, nodes.len() - 1] {
            nodes[i].cut = best_cut(&nodes[i], noted, axes);
            heap.extend(nodes[i].cut.map(|cut| Candidate { gain: cut.gain, node: i }));
        }
    }
    probable(nodes, sources)
}

/// A node for each emitter, in their order, with the samples sorted likewise.
fn whole_emitters(noted: &mut [Sample], sources: &Sources) -> Vec<Node> {
    noted.sort_by_key(|sample| sample.emitter);
    let count = noted.len() as f64;
    let mut all = Sums::default();
    noted.iter().for_each(|sample| all.add(sample));
    let mean_worth = noted.iter().map(|sample| sample.worth).sum::<f64>() / count.max(1.0);
    let mean_cost = all.mean_cost(2.0);
    let mut end = 0;
    let node = |(emitter, chance): (usize, f64)| {
        let start = end;
        let (mut sums, mut density) = (Sums::default(), PRIOR_OF_WHOLE * chance);
        while let Some(sample) = noted.get(end).filter(|s| s.emitter as usize <= emitter) {
            sums.add(sample);
            density += sample.density;
            end += 1;
        }
        // As if a few photons of the mean worth had started there besides.
        let believed = sums.count + PRIOR_OF_WHOLE;
        let share = (sums.count + PRIOR_OF_WHOLE * chance) / (count + PRIOR_OF_WHOLE);
        let of_prior = PRIOR_OF_WHOLE * mean_worth * density / believed;
        Node {
            cell: Cell::whole(emitter as u32),
            samples: start..end,
            squares: share * (sums.squares + of_prior) / believed,
            cost: sums.mean_cost(mean_cost),
            cut: None,
        }
    };
    sources.choices().map(node).collect()
}

/// The cut that gains most, if any gains enough.
fn best_cut(node: &Node, noted: &[Sample], axes: [bool; PRIMARY_NUMBERS]) -> Option<Cut> {
    let mut all = Sums::default();
    let mut bins = [[0.0; BINS]; PRIMARY_NUMBERS];
    let to_bin: [f32; PRIMARY_NUMBERS] = node.cell.size.map(|size| BINS as f32 / size);
    for sample in &noted[node.samples.clone()] {
        let squares = sample.squares();
        if squares <= 0.0 {
            continue;
        }
        all.add(sample);
        for axis in 0..PRIMARY_NUMBERS {
            let bin = ((sample.primary[axis] - node.cell.low[axis]) * to_bin[axis]) as usize;
            bins[axis][bin.min(BINS - 1)] += squares;
        }
    }
    let believed = all.effective();
    let threshold = SIGNIFICANT / believed;
    let scale = (node.squares * node.cell.volume() * node.cost).sqrt();
    let mut best: Option<Cut> = None;
    for axis in (0..PRIMARY_NUMBERS).filter(|&axis| axes[axis] && node.cell.size[axis] > SHORTEST) {
        let mut below = 0.0;
        for bin in 1..BINS {
            below += bins[axis][bin - 1];
            let volume = bin as f64 / BINS as f64;
            let squares = (believed * (below / all.squares) + PRIOR * volume) / (believed + PRIOR);
            let gain = 1.0 - (squares * volume).sqrt() - ((1.0 - squares) * (1.0 - volume)).sqrt();
            if gain > threshold && best.is_none_or(|b| gain * scale > b.gain) {
                let at = node.cell.low[axis] + node.cell.size[axis] * volume as f32;
                best = Some(Cut { axis, at, squares, gain: gain * scale });
            }
        }
    }
    best
}

/// Cuts a node: it keeps what is below, and what is above is returned.
fn divide(node: &mut Node, noted: &mut [Sample]) -> Option<Node> {
    let Cut { axis, at, squares, .. } = node.cut.take()?;
    let samples = &mut noted[node.samples.clone()];
    // Stable, so that sums keep their order whatever sorts them.
    samples.sort_by_key(|sample| sample.primary[axis] >= at);
    let middle = node.samples.start + samples.partition_point(|sample| sample.primary[axis] < at);
    let cost = |samples: &[Sample], prior| {
        let mut sums = Sums::default();
        samples.iter().for_each(|sample| sums.add(sample));
        sums.mean_cost(prior)
    };
    let mut above = Node {
        cell: node.cell,
        samples: middle..node.samples.end,
        squares: node.squares * (1.0 - squares),
        cost: cost(&noted[middle..node.samples.end], node.cost),
        cut: None,
    };
    above.cell.low[axis] = at;
    above.cell.size[axis] = node.cell.low[axis] + node.cell.size[axis] - at;
    node.cell.size[axis] = at - node.cell.low[axis];
    node.samples.end = middle;
    node.squares *= squares;
    node.cost = cost(&noted[node.samples.clone()], node.cost);
    Some(above)
}

/// The cells of all nodes with their probabilities, those of an emitter side by side.
fn probable(mut nodes: Vec<Node>, sources: &Sources) -> Cells {
    let order = |a: &f32, b: &f32| a.total_cmp(b);
    nodes.sort_by(|a, b| {
        let lows = a.cell.low.iter().zip(&b.cell.low);
        let by_place = lows.fold(Ordering::Equal, |so_far, (a, b)| so_far.then(order(a, b)));
        a.cell.emitter.cmp(&b.cell.emitter).then(by_place)
    });
    let best = |node: &Node| (node.squares * node.cell.volume() / node.cost).sqrt();
    let sum: f64 = nodes.iter().map(best).sum();
    let mut choices = sources.choices().peekable();
    let probability = |node: &Node| {
        while choices.next_if(|&(emitter, _)| emitter < node.cell.emitter as usize).is_some() {}
        let chance = choices.peek().map_or(0.0, |&(_, chance)| chance);
        DEFENSIVE_SHARE * chance * node.cell.volume() + (1.0 - DEFENSIVE_SHARE) * best(node) / sum
    };
    let probabilities = nodes.iter().map(probability).collect();
    Cells::new(nodes.into_iter().map(|node| node.cell).collect(), probabilities)
}
