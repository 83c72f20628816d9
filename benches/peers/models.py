#!/usr/bin/env python3
"""Models of rain_core beside published Python packages, interleaved in one run, as ratios.

    python3 -m venv /tmp/peers && /tmp/peers/bin/pip install landlab pyflwdir PySDM "requireit<0.6"
    /tmp/peers/bin/python benches/peers/models.py [--rounds 7] [--out FILE.csv]

- filled depressions of a fractal terrain: richdem (Zhou 2016), pyflwdir, landlab's SinkFillerBarnes
- terminal speed of a million drops: PySDM's Gunn & Kinzer interpolation and its Rogers & Yau formula

Ours are timed by `rain_peer` (package rain_bench), which reads the same numbers from files and times its own work,
without start-up and files. Every round runs each contender once, in turn; the median over rounds counts. Everybody
runs on one thread. A package that is not installed is left out, with a line that says so.
"""

import argparse
import contextlib
import csv
import importlib
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

for threads in ("OMP_NUM_THREADS", "NUMBA_NUM_THREADS", "OPENBLAS_NUM_THREADS", "RAYON_NUM_THREADS"):
    os.environ[threads] = "1"

import numpy as np  # noqa: E402 (the number of threads is read at import)

warnings.filterwarnings("ignore")
ROOT = Path(__file__).resolve().parents[2]


def timed(work):
    """Seconds that `work` takes, and what it returns; what it prints is thrown away."""
    with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere):
        start = time.perf_counter()
        result = work()
        return time.perf_counter() - start, result


def installed(name):
    try:
        return importlib.import_module(name)
    except ImportError as error:
        print(f"left out: {name} ({error})", file=sys.stderr)
        return None


class Ours:
    """`rain_peer`, built once in release."""

    def __init__(self, folder):
        self.folder = folder
        subprocess.run(
            ["cargo", "build", "--release", "--quiet", "-p", "rain_bench", "--bin", "rain_peer"], cwd=ROOT, check=True
        )
        target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
        self.program = target / "release" / "rain_peer"

    def run(self, what, numbers, *options):
        """Seconds, and the array that came back."""
        source, result = self.folder / "in.f64", self.folder / "out.f64"
        np.ascontiguousarray(numbers, dtype="<f8").tofile(source)
        line = subprocess.run(
            [self.program, what, source, result, *map(str, options)], check=True, capture_output=True, text=True
        ).stdout
        return json.loads(line)["seconds"], np.fromfile(result, dtype="<f8").reshape(np.shape(numbers))


def terrain(cells, seed=7):
    """Fractal heights in metres, 1/f^2 in power, with flats where the land is low: pits of every size."""
    rng = np.random.default_rng(seed)
    k = np.hypot(*np.meshgrid(np.fft.fftfreq(cells), np.fft.fftfreq(cells)))
    k[0, 0] = 1
    noise = np.fft.fft2(rng.standard_normal((cells, cells))) / k**1.5
    noise[0, 0] = 0
    heights = np.real(np.fft.ifft2(noise))
    heights *= 5 / heights.std()
    return np.maximum(heights, np.quantile(heights, 0.05))


def fillers(ours, heights):
    yield "rain: whole bake (tree, curves, catchments)", lambda: ours.run(
        "bake", heights, heights.shape[1], heights.shape[0]
    )
    if richdem := installed("richdem"):

        def fill_richdem():
            grid = richdem.rdarray(heights, no_data=-9999)
            seconds, filled = timed(lambda: richdem.FillDepressions(grid))
            return seconds, np.asarray(filled)

        yield "richdem FillDepressions (C++)", fill_richdem
    if pyflwdir := installed("pyflwdir"):
        yield "pyflwdir fill_depressions (numba)", lambda: timed(
            lambda: pyflwdir.dem.fill_depressions(heights, nodata=-9999.0)[0]
        )
    if landlab := installed("landlab"):
        from landlab.components import SinkFillerBarnes

        def fill_landlab():
            grid = landlab.RasterModelGrid(heights.shape)
            field = grid.add_field("topographic__elevation", heights.flatten().copy(), at="node")
            filler = SinkFillerBarnes(grid, method="D8", fill_flat=True)
            seconds, _ = timed(filler.run_one_step)
            return seconds, field.reshape(heights.shape)

        if heights.shape[0] <= 512:  # a minute beyond that
            yield "landlab SinkFillerBarnes", fill_landlab


# Gunn & Kinzer 1949, mm and m/s.
DIAMETERS = [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0, 2.2, 2.4, 2.6, 2.8, 3.0,
             3.2, 3.4, 3.6, 3.8, 4.0, 4.2, 4.4, 4.6, 4.8, 5.0, 5.2, 5.4, 5.6, 5.8]  # fmt: skip
SPEEDS = [0, 0.27, 0.72, 1.17, 1.62, 2.06, 2.47, 2.87, 3.27, 3.67, 4.03, 4.64, 5.17, 5.65, 6.09, 6.49, 6.90, 7.27, 7.57,
          7.82, 8.06, 8.26, 8.44, 8.60, 8.72, 8.83, 8.92, 8.98, 9.03, 9.07, 9.09, 9.12, 9.14, 9.16, 9.17]  # fmt: skip


def speeds(ours, diameters_mm):
    yield "rain: default fit, f64", lambda: ours.run("speed", diameters_mm)
    yield "rain: default fit, f32", lambda: ours.run("speed-f32", diameters_mm)
    yield "rain: Beard 1976, f64", lambda: ours.run("beard", diameters_mm)
    if installed("PySDM"):
        from PySDM import Formulae
        from PySDM.backends import CPU
        from PySDM.dynamics import terminal_velocity

        for name, law, formula in (
            ("PySDM Gunn & Kinzer interpolation (numba)", terminal_velocity.GunnKinzer1949, "GunnKinzer1949"),
            ("PySDM Rogers & Yau (numba)", terminal_velocity.RogersYau, "RogersYau"),
        ):
            backend = CPU(Formulae(terminal_velocity=formula))
            radius = backend.Storage.from_ndarray(diameters_mm * 0.5e-3)
            output = backend.Storage.from_ndarray(np.zeros_like(diameters_mm))
            law = law(backend)
            yield name, lambda law=law, output=output, radius=radius: (
                timed(lambda: law(output, radius))[0],
                output.to_ndarray(),
            )


def compare(title, contenders, rounds, error, per):
    """Rows of one comparison: medians, errors, ratios to our first line."""
    contenders = list(contenders)
    times = {name: [] for name, _ in contenders}
    errors = {}
    for number in range(rounds + 1):
        for name, work in contenders:
            seconds, result = work()
            if number > 0:  # the first round compiles and warms up
                times[name].append(seconds)
            errors[name] = error(result)
    base = statistics.median(times[contenders[0][0]])
    rows = []
    for name, _ in contenders:
        median = statistics.median(times[name])
        spread = (min(times[name]), max(times[name]))
        rows.append([title, name, f"{errors[name]:.2e}", f"{median / per * 1e9:.3g}", f"{spread[0] / per * 1e9:.3g}",
                     f"{spread[1] / per * 1e9:.3g}", f"{median / base:.2f}"])  # fmt: skip
        print(f"{title:28} {name:46} error {errors[name]:9.2e}  {median * 1e3:10.3f} ms  x {median / base:.2f}")
    return rows


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--rounds", type=int, default=7, help="timed rounds")
    arguments.add_argument("--out", type=Path, default=ROOT / "docs" / "benchmarks" / "peers.csv")
    options = arguments.parse_args()
    if options.rounds < 1:
        arguments.error("--rounds must be at least 1")

    from scipy.interpolate import PchipInterpolator

    rows = []
    with tempfile.TemporaryDirectory() as folder:
        ours = Ours(Path(folder))
        for cells in (256, 512, 1024):
            heights = terrain(cells)
            contenders = list(fillers(ours, heights))
            truth = contenders[0][1]()[1]
            rows += compare(f"fill {cells} x {cells}", contenders, options.rounds,
                            lambda filled: np.abs(filled - truth).max(), cells * cells)  # fmt: skip
        diameters = np.random.default_rng(3).uniform(0.2, 5.8, 1_000_000)
        measured = PchipInterpolator(DIAMETERS, SPEEDS)(diameters)
        rows += compare("terminal speed, 1e6 drops", speeds(ours, diameters), options.rounds,
                        lambda speed: np.abs(speed - measured).max(), diameters.size)  # fmt: skip
    options.out.parent.mkdir(parents=True, exist_ok=True)
    with open(options.out, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["comparison", "contender", "max_error_m_or_m_s", "ns_per_item", "ns_low", "ns_high", "ratio"])
        writer.writerows(rows)


if __name__ == "__main__":
    main()
