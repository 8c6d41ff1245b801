#!/usr/bin/env python3
"""Draws the scenes of list_borders.toml and sort_borders.toml, and the unseen ones with other seeds.

Usage: draw_borders.py [FOLDER]; writes four configs to the folder, by default that of this script.
The logarithms of all parameters are uniform: objects from 316 to 10,000 (lists), displacement from 0.0316 to 1 mean
extents (sorts), density from 0.01 to 1, ratio of edges from 1 to 100, clouds from 1 to 31.
"""

import pathlib
import random
import sys

QUICK_ROWS = 10  # with few boxes, for --quick

LISTS = {
    "title": "Where a Verlet list stops being worth its cost, along displacement",
    "drawn": "density, ratio, clouds and objects",
    "row": "objects = {objects}, displacement = [0.02, 0.032, 0.05, 0.08, 0.125, 0.2, 0.32, 0.5]",
    "frames": 48,
    "quick": "",
    "compose": 'prepare = ["none", { name = "neighbour_list", margin = [0.03, 0.1, 0.3] }]',
    "is_small": lambda objects: objects < 1000,
}
SORTS = {
    "title": "Where radix sort overtakes insertion sort, along the number of boxes",
    "drawn": "density, ratio, clouds and displacement",
    "row": "displacement = {displacement}, objects = [50, 100, 200, 400, 800, 1600, 3200, 6400, 12800]",
    "frames": 24,
    "quick": ", quick = { objects = [100, 200, 400, 800, 1600] }",
    "compose": 'sort = ["insertion", "radix"]\npartition = "none"\nsweep = "simd"',
    "is_small": lambda objects: True,
}
CONFIGS = [  # name, kind, number of rows, seed
    ("list_borders", LISTS, 60, 1),
    ("list_borders_unseen", LISTS, 50, 2),
    ("sort_borders", SORTS, 60, 3),
    ("sort_borders_unseen", SORTS, 50, 4),
]


def three_digits(x):
    x = float(f"{x:.3g}")
    return str(int(x)) if x == int(x) else repr(x)


def rows_of(kind, count, seed):
    drawn = random.Random(seed)
    quick = 0
    for _ in range(count):
        objects = 10 ** drawn.uniform(2.5, 4)
        displacement = 10 ** drawn.uniform(-1.5, 0)
        density, ratio = 10 ** drawn.uniform(-2, 0), 10 ** drawn.uniform(0, 2)
        clouds = int(10 ** drawn.uniform(0, 1.5))
        row = kind["row"].format(objects=three_digits(objects), displacement=three_digits(displacement))
        is_quick = kind["is_small"](objects) and quick < QUICK_ROWS
        quick += is_quick
        yield (
            f'    {{ kind = "cloud", {row}, density = {three_digits(density)}, ratio = {three_digits(ratio)}, '
            f'clouds = {clouds}, frames = {kind["frames"]}{kind["quick"] if is_quick else ", quick = false"} }},'
        )


def config_of(name, kind, count, seed):
    purpose = "in scenes to which its law was not fitted" if name.endswith("_unseen") else "to fit its law"
    return "\n".join(
        [
            f'# {kind["title"]}: {purpose}.',
            f'# Drawn by draw_borders.py with seed {seed}: the logarithms of {kind["drawn"]} are uniform.',
            "",
            f'name = "{name}"',
            f"seed = {seed}",
            "",
            "scene = [",
            *rows_of(kind, count, seed),
            "]",
            "",
            "[[compose]]",
            kind["compose"],
            "",
            "[measure]",
            "repeats = 5",
            'metrics = "time"',
            "quick = { repeats = 3 }",
            "",
        ]
    )


folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent)
for config in CONFIGS:
    (folder / f"{config[0]}.toml").write_text(config_of(*config))
