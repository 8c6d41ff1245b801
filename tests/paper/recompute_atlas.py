"""Recomputes the figures of an atlas, maps of the fastest candidate and curves of regrets, from the rows of its
experiments, without any code of the program that drew them."""

import csv
import json
import re

from recompute import KINDS, median, metric
from recompute_lines import Lines

PARTS = ("atlas", "atlas_large", "atlas_unseen")
MOST_SERIES = 7
TIMES = ("build", "first", "update", "search", "detect")


def as_text(text):
    """JSON whose numbers stay as they are written."""
    return json.loads(text, parse_float=str, parse_int=str)


class Scene:
    """A scene of the atlas: its parameters, and the times per frame of each candidate by label."""

    def __init__(self, kind, parameters, defaults, row):
        self.kind = kind
        self.parameters = {**defaults, **parameters}
        self.objects = float(row["objects"])
        self.inversions = None  # per object and frame; None where they are not recorded, or nothing moves
        self.times, self.medians, self.automatic = {}, {}, set()

    def number(self, name):
        return float(self.parameters[name])

    def add(self, row):
        label = row["engine"] or " + ".join(
            row[k] for k in KINDS if row[k] not in ("", "none") and (k, row[k]) != ("build", "median")
        )
        if label == "auto" or label.startswith("auto + "):
            self.automatic.add(label)
        self.times.setdefault(label, []).append(metric("frame_cpu_ms", row))

    def ms(self, label):
        if label not in self.medians:
            self.medians[label] = median(self.times[label])
        return self.medians[label]

    def regret(self, label):
        """The time over the least of the scene."""
        return self.ms(label) / min(map(self.ms, self.times))

    def fastest(self):
        return min((label for label in self.times if label not in self.automatic), key=self.ms)

    def without_columns(self):
        """The same with neither `columns` nor what selects it; None if nothing is left."""
        other = Scene.__new__(Scene)
        other.__dict__.update(self.__dict__)
        other.times = {k: v for k, v in self.times.items() if k not in self.automatic and "columns" not in k}
        return other if other.times else None


def is_timed(row):
    has_times = all(row[t + "_cpu_ms"] for t in TIMES)
    return row["status"] == "exact" and has_times and metric("frame_cpu_ms", row) > 0


def scenes_of(folder):
    """The scenes of an experiment in the order of its config, and whether their measures are recorded."""
    manifest = as_text((folder / "manifest.json").read_text(encoding="utf-8"))
    defaults = manifest.get("defaults", {}).get("scenes", {})
    inversions = {}
    has_measures = (folder / "measures.csv").exists()
    if has_measures:
        with open(folder / "measures.csv", newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                inversions[row["scene"], row["scene_parameters"], row["seed"]] = float(row["inversions"] or 0)
    known = {(s["kind"], json.dumps(s["parameters"]), s.get("seed") or ""): None for s in manifest["scenes"]}
    with open(folder / "results.csv", newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if not is_timed(row):
                continue
            parameters = as_text(row["scene_parameters"])
            key = row["scene"], json.dumps(parameters), row["seed"]
            if known[key] is None:
                known[key] = Scene(row["scene"], parameters, defaults.get(row["scene"], {}), row)
                known[key].inversions = inversions.get((row["scene"], row["scene_parameters"], row["seed"]))
            known[key].add(row)
    return [s for s in known.values() if s and set(s.times) - s.automatic], has_measures


def family_of(label):
    """The strategies without their parameters."""
    return re.sub(":[^ ]*", "", label)


def winners_of(scenes):
    """The families that win most scenes, by number and name."""
    wins = {}
    for scene in scenes:
        family = family_of(scene.fastest())
        wins[family] = wins.get(family, 0) + 1
    return sorted(wins, key=lambda family: (-wins[family], family))[:MOST_SERIES]


def maps_of(scenes, prefix, has_measures):
    winners = winners_of(scenes)

    def series(scene):
        family = family_of(scene.fastest())
        return family if family in winners else "another"

    figures = {}
    for scene in scenes:
        if scene.kind != "cloud":
            continue
        lines = figures.setdefault(f"{prefix}{scene.number('clouds'):g}", Lines())
        if scene.number("moving") == 1:
            panel = f"density {scene.number('density'):g}, sizes 1 to {scene.number('ratio'):g}"
            lines.add(series(scene), [{"x": scene.number("objects"), "y": scene.number("displacement")}], panel)
    if has_measures:
        lines = figures[prefix + "inversions"] = Lines()
        for scene in scenes:
            if scene.inversions:
                lines.add(series(scene), [{"x": scene.objects, "y": scene.inversions}])
    return figures


def regret_of(scenes):
    """The curves of the candidates with the least median: times over the least of the scene, in ascending order."""
    curves = []
    for label in dict.fromkeys(label for scene in scenes for label in scene.times):
        regrets = sorted(s.regret(label) for s in scenes if label in s.times)
        if len(regrets) >= max(2, len(scenes) // 2):
            curves.append((label, regrets))
    curves.sort(key=lambda curve: curve[1][len(curve[1]) // 2])
    lines = Lines()
    for label, regrets in curves[:MOST_SERIES]:
        lines.add(label, [{"x": (i + 0.5) / len(regrets), "y": regret} for i, regret in enumerate(regrets)])
    return lines


def atlas_figures(folder):
    """The figures by name, and why others cannot be recomputed, by name."""
    scenes, has_measures = [], True
    for part in PARTS:
        if (folder / part / "results.csv").exists():
            of_part, is_measured = scenes_of(folder / part)
            scenes += of_part
            has_measures &= is_measured
    if not scenes:
        return {}, {}
    others = [other for scene in scenes if (other := scene.without_columns())]
    figures = maps_of(scenes, "map_", has_measures)
    if others:
        figures.update(maps_of(others, "map_classic_", has_measures))
    figures["regret"] = regret_of(scenes)
    missing = "there are no measures of scenes, atlas/PART/measures.csv"
    return figures, {} if has_measures else {name: missing for name in ("map_inversions", "map_classic_inversions")}
