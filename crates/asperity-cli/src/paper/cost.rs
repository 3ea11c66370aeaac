//! Cost of sub-matrices compared with circular shifting: theory, measurement, verdict.

use std::path::Path;
use std::time::Instant;

use asperity::motion::{Pair, Position, Strategy};
use asperity::operator::{Boundary, DirectSum, Operator, Operators};
use asperity::solver::{Bounds, Control, Method, Params, Solution, solve_normal};
use asperity::units::{Dimension, Second, format};

use indicatif::ProgressBar;

use super::{CUTOFF, PITCH, POISSON, SQ, YOUNG, pair};
use asperity_report::draw::{self, Axis, Caption, Chart, Charts, Mark, Paper, Series, Unit};

/// Number of timings of each size. Both strategies and all sizes alternate, so that a temporarily slow
/// machine affects all of them.
const TURNS: usize = 5;
/// Mean pressure over E* at the approach of all positions. The contact fraction is large.
const PRESSURE: f64 = 0.01;

/// Method of solving the contact at a position. The work grows as the power q of the number of columns in the
/// overlap.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Work {
    /// Dense matrices, factorised: the paper's direct quadratic programming.
    Factorisation,
    /// Conjugate gradients on dense matrices.
    Product,
    /// Conjugate gradients on transforms.
    Transform,
}

impl Work {
    const ALL: [Self; 3] = [Self::Factorisation, Self::Product, Self::Transform];

    fn name(self) -> &'static str {
        match self {
            Self::Factorisation => "factorisation",
            Self::Product => "matrix product",
            Self::Transform => "FFT",
        }
    }

    /// Returns q + 1: the mean of n^q over the positions of a pass is 1/(q + 1) of its largest value.
    fn theory(self) -> f64 {
        match self {
            Self::Factorisation => 4.0,
            Self::Product => 3.0,
            Self::Transform => 2.0,
        }
    }

    /// Returns the numbers of cells per side, up to `largest` by transforms. Larger dense matrices take
    /// minutes.
    fn sides(self, largest: usize) -> Vec<usize> {
        match self {
            Self::Factorisation => (12..=32).step_by(4).collect(),
            Self::Product => vec![16, 24, 32, 40, 48],
            Self::Transform => [16, 32, 64, 128, 256, 512].into_iter().filter(|n| *n <= largest).collect(),
        }
    }

    /// Returns the columns from one position to the next. Neighbouring positions have similar costs, so a few
    /// dozen give the mean.
    fn stride(self, side: usize) -> usize {
        match self {
            Self::Transform => (side / 32).max(1),
            Self::Factorisation | Self::Product => 1,
        }
    }
}

/// One size, by one method.
pub(super) struct Cost {
    work: Work,
    side: usize,
    /// Seconds per position of a pass by sub-matrices and by circular shifting, in each turn.
    turns: Vec<[Second; 2]>,
}

impl Cost {
    /// Returns the median time of a position: 0 by sub-matrices, 1 by circular shifting.
    fn time(&self, strategy: usize) -> Second {
        median(self.turns.iter().map(|turn| turn[strategy]))
    }

    /// Returns the speed-up by sub-matrices: the median over the turns.
    fn ratio(&self) -> f64 {
        median(self.turns.iter().map(|[parts, shift]| shift / parts))
    }
}

/// All sizes, by all methods; one thread, elastic, frozen surfaces, one approach.
pub(super) struct Costs(Vec<Cost>);

impl Costs {
    /// Times all sizes, by transforms up to `largest` cells along a side.
    pub(super) fn measure(largest: usize, bar: &ProgressBar) -> asperity::Result<Self> {
        bar.set_message("cost: preparing");
        let mut tasks = Vec::new();
        for work in Work::ALL {
            for side in work.sides(largest) {
                tasks.push((Task::new(work, side)?, Cost { work, side, turns: Vec::new() }));
            }
        }
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of one thread");
        one.install(|| {
            for turn in 1..=TURNS {
                for (task, cost) in &mut tasks {
                    let Cost { work, side, .. } = *cost;
                    bar.set_message(format!(
                        "cost: turn {turn}/{TURNS}, {} of {side} × {side} cells",
                        work.name()
                    ));
                    cost.turns.push([task.time(&task.parts)?, task.time(&task.shift)?]);
                }
            }
            Ok(Self(tasks.into_iter().map(|(_, cost)| cost).collect()))
        })
    }

    pub(super) fn table(&self) -> String {
        let mut text = format!(
            "time of a position, mean over a pass: median of {TURNS} turns\n\
             N × N cells of {}, Sq {}, cut-off {}; E = {}, ν = {POISSON}, elastic;\n\
             one approach, at which N × N cells bear {PRESSURE} E*; free boundary; one thread\n\
             {:<16}{:>6}{:>20}{:>18}{:>8}{:>8}\n",
            format(PITCH, Dimension::Length),
            format(SQ, Dimension::Length),
            format(CUTOFF, Dimension::Length),
            format(YOUNG, Dimension::Pressure),
            "solved by",
            "N",
            "circular shift, ms",
            "sub-matrices, ms",
            "ratio",
            "theory"
        );
        for cost in &self.0 {
            let [parts, shift] = [0, 1].map(|strategy| 1e3 * cost.time(strategy));
            text.push_str(&format!(
                "{:<16}{:>6}{shift:>20.3}{parts:>18.3}{:>8.2}{:>8.0}\n",
                cost.work.name(),
                cost.side,
                cost.ratio(),
                cost.work.theory()
            ));
        }
        text + "theory: the work grows as the number of facing columns to the power q = 3, 2, 1; ratio q + 1\n"
    }

    /// Returns the verdict on the paper's claim.
    pub(super) fn verdict(&self) -> String {
        let range = |work: Work| {
            let ratios: Vec<f64> = self.0.iter().filter(|c| c.work == work).map(Cost::ratio).collect();
            let [low, high] = [f64::min as fn(f64, f64) -> f64, f64::max]
                .map(|pick| ratios.iter().copied().reduce(pick).unwrap_or(f64::NAN));
            (low, high, ratios.last().copied().unwrap_or(f64::NAN))
        };
        let (low, high, last) = range(Work::Factorisation);
        // Here "several" means more than two.
        let holds = if low > 2.0 { "holds" } else { "does not hold at every size" };
        let others = [Work::Product, Work::Transform].map(|work| {
            let (low, high, _) = range(work);
            format!("{} {low:.1} to {high:.1} times", work.name())
        });
        format!(
            "Sub-matrices are {low:.1} to {high:.1} times as fast as shifting with dense factorisations ({last:.1} at the \
             largest, theory 4): the paper's claim of several times {holds}. By {}, by {}.\n",
            others[0], others[1]
        )
    }

    /// Returns the rows of `cost.csv`.
    pub(super) fn csv(&self) -> String {
        let mut text = "method,cells_per_side,turn,sub_matrices_s,circular_shift_s,ratio,theory\n".to_owned();
        for cost in &self.0 {
            for (turn, [parts, shift]) in cost.turns.iter().enumerate() {
                text.push_str(&format!(
                    "{},{},{},{parts:e},{shift:e},{},{}\n",
                    cost.work.name(),
                    cost.side,
                    turn + 1,
                    shift / parts,
                    cost.work.theory()
                ));
            }
        }
        text
    }

    pub(super) fn draw(&self, path: &Path, sheet: &Paper) -> draw::Result<()> {
        let series = |work: Work, strategy: usize, name: &str| {
            let costs = self.0.iter().filter(|cost| cost.work == work);
            let points = costs.map(|cost| [cost.side as f64, cost.time(strategy)]).collect();
            // The colour stands for the method, the line for the strategy.
            let mark = if strategy == 0 { Mark::LineAndPoints } else { Mark::DashedAndPoints };
            Series::new(format!("{}, {name}", work.name()), points, mark)
        };
        let all = |work| [series(work, 1, "shift"), series(work, 0, "sub-matrices")];
        let x = Axis::log("cells along a side", Unit::Number);
        let chart =
            Chart::new("", x, Axis::log("time", Unit::Time), Work::ALL.into_iter().flat_map(all).collect());
        let caption = Caption {
            title: "Mean time of a position over a pass".to_owned(),
            of: format!("median of {TURNS} turns, one thread, elastic, one approach"),
        };
        draw::save(path, &Charts::from(chart), &caption, sheet)
    }
}

/// A pair of equal bodies in a pass with both strategies.
struct Task {
    work: Work,
    pair: Pair,
    operators: Operators,
    control: Control,
    parts: Vec<Position>,
    shift: Vec<Position>,
}

impl Task {
    fn new(work: Work, side: usize) -> asperity::Result<Self> {
        let pair = pair(side)?;
        let gap = pair.initial_gap(&pair.at_rest());
        let operators = Operators::new(pair.lower_grid(), *pair.compliances(), Boundary::FREE);
        let load = Control::Load(PRESSURE * pair.modulus() * pair.lower_grid().area());
        let mut operator = operators.on([side; 2]);
        let full = solve_normal(operator.as_mut(), &gap, &Bounds::ELASTIC, load, None, &Params::default())?;
        let positions = |strategy: Strategy| strategy.positions(side, side, work.stride(side));
        let shift = Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 };
        Ok(Self {
            work,
            control: Control::Approach(full.approach),
            parts: positions(Strategy::Overlap),
            shift: positions(shift),
            operators,
            pair,
        })
    }

    /// Returns the mean time of one of the `positions`.
    fn time(&self, positions: &[Position]) -> asperity::Result<Second> {
        let began = Instant::now();
        positions.iter().try_for_each(|position| self.solve(position).map(drop))?;
        Ok(began.elapsed().as_secs_f64() / positions.len() as f64)
    }

    fn solve(&self, position: &Position) -> asperity::Result<Solution> {
        let gap = self.pair.initial_gap(position);
        let grid = self.pair.grid(position.columns);
        let mut operator: Box<dyn Operator> = match self.work {
            Work::Transform => self.operators.on(grid.shape),
            Work::Factorisation | Work::Product => Box::new(DirectSum::new(grid, self.pair.modulus())),
        };
        let method = match self.work {
            Work::Factorisation => Method::Direct,
            Work::Product | Work::Transform => Method::ActiveSet,
        };
        let params = Params::default().with_method(method);
        solve_normal(operator.as_mut(), &gap, &Bounds::ELASTIC, self.control, None, &params)
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_unstable_by(f64::total_cmp);
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[n / 2],
        n => 0.5 * (values[n / 2 - 1] + values[n / 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn costs(turns: &[[f64; 2]]) -> Costs {
        let cost = |work| Cost { work, side: 32, turns: turns.to_vec() };
        Costs(Work::ALL.map(cost).into())
    }

    #[test]
    fn a_turn_that_the_machine_spoilt_does_not_change_the_ratio() {
        let costs = costs(&[[1.0, 4.0], [1.0, 3.0], [9.0, 3.5], [1.0, 3.5], [1.1, 3.3]]);
        let ratio = costs.0[0].ratio();
        assert!((ratio - 3.0).abs() < 0.6, "{ratio}");
        assert!(costs.verdict().contains("several times holds"), "{}", costs.verdict());
        assert_eq!(costs.csv().lines().count(), 1 + 3 * 5);
    }

    #[test]
    fn a_ratio_below_two_is_not_called_several_times() {
        assert!(costs(&[[1.0, 1.5]]).verdict().contains("does not hold"));
    }

    #[test]
    fn all_methods_solve_the_same_contacts() {
        let tasks = Work::ALL.map(|work| Task::new(work, 12).unwrap());
        for task in &tasks {
            assert_eq!((task.parts.len(), task.shift.len()), (23, 12));
            for (own, first) in [(&task.parts, &tasks[0].parts), (&task.shift, &tasks[0].shift)] {
                for (own, first) in own.iter().zip(first) {
                    let [load, exact] =
                        [task.solve(own), tasks[0].solve(first)].map(|solution| solution.unwrap().load());
                    assert!((load - exact).abs() <= 1e-6 * exact, "{} for {exact}", load);
                }
            }
        }
    }
}
