//! Two echoes in turn, and whether there are two.

use crate::firmware::likelihood_estimator::targets::{
    HINT, LEAST_APART, LEAST_DROP, NEAR, TURNS, Targets,
};
use crate::firmware::tof_top::status::Status;
use crate::firmware::tof_top::status_code::{CodeConditions, StatusCode};

use super::histogram::Shots;
use super::instrument::Instrument;
use super::number::Number;
use super::point::{Echo, Point};
use super::scan::{Best, scan};
use super::step::{Information, step};
use super::verdict::{Found, Judged, Second, verdict};

/// A fit of two echoes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turns<N> {
    /// The point after each step; the echo that it has moved comes first in it.
    pub points: [Point<N>; TURNS],
    /// The highest place of the box above both.
    pub third: Best<N>,
    /// Chi-square over the same bins with the first echo alone, and with both.
    pub chi_squares: [N; 2],
    /// Distance between both [units / 16].
    pub apart: N,
    /// Both are taken for echoes.
    pub are_two: bool,
}

/// Looks for a second target after a fit of one has ended at a point. The other echo begins where a box is highest above
/// the light of one.
pub fn find<I: Instrument>(
    p: &I,
    shots: &Shots<I::Number>,
    [start, rest]: [&Best<I::Number>; 2],
    alone: &Point<I::Number>,
    information: &Information<I::Number>,
) -> (Judged<I::Number>, Turns<I::Number>) {
    let Point { arrival, signal, .. } = rest.start(p, alone);
    let dark = Point { other: Some(Echo { arrival, signal: I::Number::default() }), ..*alone };
    let one = verdict(p, shots, [start, rest], &dark, information);
    let mut point = Point { other: Some(Echo { arrival, signal }), ..*alone };
    let mut informations = [Information::default(); 2];
    let points = std::array::from_fn(|turn| {
        (point, informations[turn % 2]) = step(p, shots, &point.swapped());
        point
    });
    let third = scan(p, shots, &point, 0..0);
    let [other, own] = informations;
    let other = verdict(p, shots, [start, &third], &point.swapped(), &other);
    let own = verdict(p, shots, [start, &third], &point, &own);

    let other_echo = point.other.unwrap_or(Echo { arrival, signal });
    let chi_squares = [one.found.chi_square, own.found.chi_square];
    let drop = chi_squares[0] - chi_squares[1];
    let apart = (point.arrival - other_echo.arrival).abs();
    let (sigma, whole) = (p.scales().sigma, I::Number::whole);
    let is_certain = |echo: &Judged<I::Number>| !echo.flags[1] && !echo.flags[2];
    let is_lower = drop > whole(LEAST_DROP);
    let are_two =
        is_lower && apart > whole(LEAST_APART) * sigma && is_certain(&own) && is_certain(&other);
    let turns = Turns { points, third, chi_squares, apart, are_two };
    if !are_two {
        let is_split = is_lower || drop > whole(HINT) && apart < whole(NEAR) * sigma;
        let status =
            if is_split { one.found.status.with(Status::Another) } else { one.found.status };
        let code = StatusCode::of(status, one.conditions);
        return (Judged { found: Found { status, code, ..one.found }, ..one }, turns);
    }
    let is_first = match p.words().targets {
        Targets::StrongestFirst => point.signal >= other_echo.signal,
        _ => own.found.depth <= other.found.depth,
    };
    let [(first, _), (second, signal)] = if is_first {
        [(own, point.signal), (other, other_echo.signal)]
    } else {
        [(other, other_echo.signal), (own, point.signal)]
    };
    let without_score = |found: &Found<I::Number>| found.status.without(Status::NoEcho);
    let Found { depth, sigma, .. } = second.found;
    let second = Second { depth, sigma, signal, status: without_score(&second.found) };
    let status = without_score(&first.found);
    let conditions = CodeConditions { has_second: true, ..first.conditions };
    let code = StatusCode::of(status, conditions);
    let found = Found { status, code, second: Some(second), ..first.found };
    (Judged { found, flags: one.flags, waiting: one.waiting, conditions }, turns)
}
