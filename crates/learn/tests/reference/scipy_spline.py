"""Writes scipy_spline.csv and scipy_peaks.csv, what scipy makes of the inputs of tests/estimators.rs.

Inputs come from a linear congruential generator that both sides have, so only outputs are kept.
    python3 scipy_spline.py        (scipy 1.17)
"""

import csv
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import find_peaks, peak_prominences, peak_widths

HERE = Path(__file__).parent


class Lcg:
    """x <- 6364136223846793005 x + 1442695040888963407 modulo 2^64 (Knuth's MMIX)."""

    def __init__(self, seed):
        self.state = seed

    def below(self, limit):
        self.state = (self.state * 6364136223846793005 + 1442695040888963407) % 2**64
        return (self.state >> 33) % limit


def spline_case(seed):
    """Knots and values in thousandths, 2 to 13 of them, and five places within and beyond."""
    lcg = Lcg(seed)
    count = 2 + seed % 12
    knots, values = [lcg.below(1000)], []
    for _ in range(count - 1):
        knots.append(knots[-1] + 1 + lcg.below(2000))
    for _ in range(count):
        values.append(lcg.below(20000) - 10000)
    places = [knots[0] - 100 + lcg.below(knots[-1] - knots[0] + 200) for _ in range(5)]
    return [np.array(part) / 1000 for part in (knots, values, places)]


def histogram(seed):
    """A falling slope with noise, and one to three triangular echoes."""
    lcg = Lcg(seed)
    start, fall = lcg.below(400), lcg.below(4)
    counts = [max(start - fall * k, 0) + lcg.below(1 + start // 4) for k in range(256)]
    for _ in range(1 + lcg.below(3)):
        centre, height, half = lcg.below(256), lcg.below(700), 4 + lcg.below(30)
        for k in range(256):
            counts[k] += height * max(half - abs(k - centre), 0) // half
    return counts


def half_height_peaks(x, y, prominence, max_width):
    """find_peaks with the width at half height, between the borders that MATLAB has for it."""
    peaks, _ = find_peaks(y, height=np.nextafter(0, 1))
    prominences, left, right = peak_prominences(y, peaks)
    kept = prominences >= prominence
    peaks, prominences, left, right = (part[kept] for part in (peaks, prominences, left, right))
    lows, highs = list(left), list(right)
    for k in range(1, len(peaks)):
        if right[k - 1] <= peaks[k]:
            lows[k] = max(left[k], right[k - 1])
        if left[k] >= peaks[k - 1]:
            highs[k - 1] = min(right[k - 1], left[k])
    step = x[1] - x[0]
    result = []
    for k, peak in enumerate(peaks):
        data = (np.array([y[peak]]), np.array([lows[k]]), np.array([highs[k]]))
        width = peak_widths(y, [peak], rel_height=0.5, prominence_data=data)[0][0] * step
        if width <= max_width:
            result.append((x[peak], width, prominences[k]))
    return result


def main():
    with open(HERE / "scipy_spline.csv", "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["seed", "values"])
        for seed in range(100):
            knots, values, places = spline_case(seed)
            found = CubicSpline(knots, values, bc_type="not-a-knot")(places)
            out.writerow([seed, " ".join(f"{value:.12g}" for value in found)])
    centres = (np.arange(256) + 0.5) * 25.0
    x = np.linspace(centres[0], centres[-1], 100)
    with open(HERE / "scipy_peaks.csv", "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["seed", "location_ps", "width_ps", "prominence"])
        for seed in range(1000):
            y = CubicSpline(centres, histogram(seed), bc_type="not-a-knot")(x)
            rows = half_height_peaks(x, y, 90.0, 2000.0)
            for row in rows:
                out.writerow([seed] + [f"{value:.13g}" for value in row])


main()
