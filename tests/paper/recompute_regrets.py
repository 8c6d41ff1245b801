#!/usr/bin/env python3
"""Compares the atlas's tables of regrets with its times, without any code of the program that wrote them.

recompute_regrets.py FOLDER: recomputes regrets.csv, regrets_whole.csv and regrets_unseen.csv in the folder from its
times.csv.xz. Ends with 1 where a row differs.
"""

import csv
import lzma
import pathlib
import sys

from recompute import median
from recompute_atlas import PARTS


def read_times(file):
    """By experiment and scene: the times per frame and those of all frames, by candidate."""
    scenes = {}
    with lzma.open(file, "rt", newline="", encoding="utf-8") as text:
        for row in csv.DictReader(text):
            if row["experiment"] not in PARTS:
                continue
            key = row["experiment"], row["scene"], row["scene_parameters"], row["seed"]
            first, later = float(row["first_cpu_ms"]), float(row["later_cpu_ms"])
            times = scenes.setdefault(key, {}).setdefault(row["candidate"], ([], []))
            times[0].append(later / (int(row["frames"]) - 1))
            times[1].append(first + later)
    return scenes


def regrets_table(scenes, which):
    """The rows of a table of regrets, times over the least of the scene, in any order."""
    regrets = {}
    for times in scenes:
        medians = {label: median(of_label[which]) for label, of_label in times.items()}
        least = min(medians.values())
        for label, ms in medians.items():
            regrets.setdefault(label, []).append(ms / least)
    table = []
    for label, values in regrets.items():
        values.sort()
        numbers = median(values), values[len(values) * 9 // 10], values[-1]
        table.append([label, str(len(values)), *(f"{n:.2f}" for n in numbers), str(sum(v > 1.3 for v in values))])
    return table


def main(folder):
    scenes = read_times(folder / "times.csv.xz")
    unseen = [times for key, times in scenes.items() if key[0] == "atlas_unseen"]
    status = 0
    for name, chosen, which in (
        ("regrets", scenes.values(), 0),
        ("regrets_whole", scenes.values(), 1),
        ("regrets_unseen", unseen, 0),
    ):
        with open(folder / f"{name}.csv", newline="", encoding="utf-8") as file:
            stated = [[cell.replace(",", "") for cell in row[1:]] for row in list(csv.reader(file))[1:]]
        computed = regrets_table(chosen, which)
        for row in computed:
            row[0] = row[0].replace(",", "")
        wrong = [row for row in stated if row not in computed] + [row for row in computed if row not in stated]
        print(f"{name}.csv: {len(computed)} candidates in {len(chosen)} scenes, {len(wrong)} rows differ")
        for row in wrong:
            print("   ", ", ".join(row))
        status |= bool(wrong)
    return status


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
