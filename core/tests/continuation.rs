//! Continuation of curves with smooth folds, corners, near misses and closed loops.
#![allow(clippy::unwrap_used, clippy::panic)]

use faer::mat;
use stickslip_core::solve::{
    at_parameter, factorised_with, Advance, Bounds, Branch, Continuation, Curve, End, Steps,
};

/// `p = 1 − |x| − x²/4`: a fold at a corner; with `smooth`, `p = 1 − x²`.
struct Fold {
    smooth: bool,
}

impl Curve for Fold {
    fn unknowns(&self) -> usize {
        2
    }

    fn residual(&mut self, z: &[f64], out: &mut [f64]) {
        let x = z[0];
        let height = if self.smooth { x * x } else { x.abs() + 0.25 * x * x };
        out[0] = z[1] - 1.0 + height;
    }

    fn solve_bordered(
        &mut self,
        z: &[f64],
        border: &[f64],
        right: &[f64],
        weights: &[f64],
    ) -> Option<(Vec<f64>, f64)> {
        let x = z[0];
        let slope = if self.smooth { 2.0 * x } else { x.signum() + 0.5 * x };
        factorised_with(mat![[slope, 1.0], [0.0, 0.0]], border, right, weights)
    }

    fn weights(&self, _: &[f64]) -> Vec<f64> {
        vec![1.0, 1.0]
    }

    fn accept(&mut self, _: &[f64]) {}
}

fn walk(smooth: bool) -> Vec<Vec<f64>> {
    let mut curve = Fold { smooth };
    let height = if smooth { 1.0 } else { 1.25 };
    let start = vec![-1.0, 1.0 - height];
    let mut walk = Continuation::new(&mut curve, start, 1.0, Steps::default());
    let mut points = Vec::new();
    while walk.point[0] < 1.0 && points.len() < 500 {
        assert_eq!(walk.advance(&mut curve), Advance::Point, "{:?}", walk.point);
        points.push(walk.point.clone());
    }
    points
}

#[test]
fn a_walk_goes_around_smooth_folds_and_corners() {
    for smooth in [true, false] {
        let points = walk(smooth);
        assert!(points.len() < 200);
        assert!(points.windows(2).all(|pair| pair[1][0] > pair[0][0]));
        let top = points.iter().map(|p| p[1]).fold(f64::MIN, f64::max);
        assert!(top > 0.9 && top <= 1.0, "{top}");
    }
}

#[test]
fn a_point_is_found_at_a_parameter() {
    let mut curve = Fold { smooth: true };
    let (z, _) = at_parameter(&mut curve, &[-0.8, 0.4], 0.19, 20).unwrap();
    assert!((z[0] + 0.9).abs() < 1e-12);
    assert!(at_parameter(&mut curve, &[-0.3, 0.9], 1.1, 20).is_none());
}

/// One equation in `x` and the parameter.
struct Plane<F: Fn(f64, f64) -> [f64; 3]>(F);

impl<F: Fn(f64, f64) -> [f64; 3]> Curve for Plane<F> {
    fn unknowns(&self) -> usize {
        2
    }

    fn residual(&mut self, z: &[f64], out: &mut [f64]) {
        out[0] = self.0(z[0], z[1])[0];
    }

    fn solve_bordered(
        &mut self,
        z: &[f64],
        border: &[f64],
        right: &[f64],
        weights: &[f64],
    ) -> Option<(Vec<f64>, f64)> {
        let [_, by_x, by_p] = self.0(z[0], z[1]);
        factorised_with(mat![[by_x, by_p], [0.0, 0.0]], border, right, weights)
    }

    fn weights(&self, _: &[f64]) -> Vec<f64> {
        vec![1.0, 1.0]
    }

    fn accept(&mut self, _: &[f64]) {}
}

/// `p = −1 … 0` on `x = 0`, and back along `x = p/4`: the boundary of a wedge.
#[test]
fn a_walk_passes_a_corner_that_turns_by_more_than_a_right_angle() {
    let wedge = |x: f64, p: f64| {
        let (a, b) = (-x, x - 0.25 * p);
        if a < b {
            [a, -1.0, 0.0]
        } else {
            [b, 1.0, -0.25]
        }
    };
    let mut curve = Plane(wedge);
    let mut walk = Continuation::new(&mut curve, vec![0.0, -1.0], 1.0, Steps::default());
    for _ in 0..200 {
        assert_eq!(walk.advance(&mut curve), Advance::Point, "{:?}", walk.point);
        if walk.point[1] < -0.9 && walk.point[0] < -0.1 {
            return;
        }
    }
    panic!("{:?}", walk.point);
}

/// `x² − p² = ε²`: two branches that nearly cross, and are left to either side of each other.
#[test]
fn a_walk_does_not_change_over_to_a_branch_that_comes_near() {
    let hyperbola = |x: f64, p: f64| [x * x - p * p - 1e-6, 2.0 * x, -2.0 * p];
    let mut curve = Plane(hyperbola);
    let start = vec![-(1.0_f64 + 1e-6).sqrt(), -1.0];
    let mut walk = Continuation::new(&mut curve, start, 1.0, Steps::default());
    while walk.point[1] < 1.0 {
        assert_eq!(walk.advance(&mut curve), Advance::Point, "{:?}", walk.point);
        assert!(walk.point[0] < 0.0, "{:?}", walk.point);
    }
}

/// `(ω − 2)² + p² = 1` about p = 2: a closed loop, with a motion that does not matter.
struct Loop;

impl Curve for Loop {
    fn unknowns(&self) -> usize {
        3
    }

    fn scalars(&self, _: &[f64]) -> usize {
        1
    }

    fn residual(&mut self, z: &[f64], out: &mut [f64]) {
        out[0] = z[0] - 1.0;
        out[1] = (z[1] - 2.0).powi(2) + (z[2] - 2.0).powi(2) - 1.0;
    }

    fn solve_bordered(
        &mut self,
        z: &[f64],
        border: &[f64],
        right: &[f64],
        weights: &[f64],
    ) -> Option<(Vec<f64>, f64)> {
        let [y, p] = [1, 2].map(|i| 2.0 * (z[i] - 2.0));
        let matrix = mat![[1.0, 0.0, 0.0], [0.0, y, p], [0.0, 0.0, 0.0]];
        factorised_with(matrix, border, right, weights)
    }

    fn weights(&self, _: &[f64]) -> Vec<f64> {
        vec![1.0; 3]
    }

    fn accept(&mut self, _: &[f64]) {}
}

#[test]
fn a_walk_round_a_loop_ends_where_it_comes_back() {
    let bounds = Bounds { range: (0.0, 10.0), most: 1000, ends: &|_| false };
    let branch =
        Branch::continue_branch(&mut Loop, vec![1.0, 1.0, 2.0], 1.0, Steps::default(), &bounds);
    assert_eq!(branch.end, End::Returned);
    // What was walked after the second turn is not known to be new.
    let last = branch.points.len() - 1;
    let turns = branch.folds.iter().chain([&last]);
    let turns: Vec<f64> = turns.map(|at| branch.points[*at][2]).collect();
    assert!((turns[0] - 3.0).abs() < 1e-9 && (turns[1] - 1.0).abs() < 1e-9, "{turns:?}");
    assert!(branch.points.len() < 200);
}
