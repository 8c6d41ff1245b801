"""Recomputes the points of a reproduction's figures from its rows, without any code of the program that drew them.

`check` compares each figure of the claims, which macros.tex lists, of the studies of error against run time, of bodies in
contact and of the small atlas with figures/NAME.csv, point by point, and reports which figures it does not recompute, and
why.
"""

import csv
import itertools
import json
import math
import re
import tomllib

from recompute import (
    CELL_SIZES,
    CUT,
    Cells,
    KINDS,
    bootstrap,
    grid,
    mean_ratio,
    median,
    metric,
    numbers,
    student_quantile,
)
from recompute_atlas import atlas_figures
from recompute_lines import Lines, differences_of, drawn
from recompute_stiff import stiff_figures

TRADITIONAL = {"sort": "insertion", "partition": "none", "sweep": "one_axis"}
AXIAL_CUT = {"partition": "axial_cut:axes=2"}
SHELL = {**TRADITIONAL, "sort": "shell"}
IMPROVED = {**SHELL, **AXIAL_CUT}
GAPS = ["ciura", "ciura_eight", "four_one", "tokuda", "shell"]
SORTS = ["shell:gaps=" + gaps for gaps in ("ciura", "tokuda", "shell", "ciura_eight", "four_one")] + ["insertion"]
FRONT = "Pareto front"


# Numbers of rows.


def quantile(values, share):
    """Between the two nearest values."""
    values = sorted(values)
    position = share * (len(values) - 1)
    below = math.floor(position)
    above = min(below + 1, len(values) - 1)
    return values[below] + (values[above] - values[below]) * (position - below)


def value_of(name, row):
    """A metric of a row, or None."""
    frames = int(row["frames"])
    later = max(frames - 1, 1)
    if name in ("whole_ms", "whole_cpu_ms"):
        suffix = name.removeprefix("whole")
        parts = [numbers(row[part + suffix]) for part in ("build", "first", "update", "search", "detect")]
        return None if None in parts else sum(parts)
    if name == "frame_ms":
        if not row["update_ms"] or frames == 1:
            return numbers(row["first_ms"])
        return sum(float(row[part + "_ms"]) for part in ("update", "search", "detect")) / later
    if name == "tree_bytes":  # per triangle
        parts = [numbers(row["bytes_nodes"]), numbers(row["bytes_indices"])]
        triangles = numbers(row["triangles"])
        return sum(part or 0 for part in parts) / triangles if triangles and parts != [None, None] else None
    if name == "wrong_share":
        if not row["missing"]:
            return None
        missing, invented = float(row["missing"]), float(row["invented"])
        reported = float(row["contacts"] or row["candidates"])
        return (missing + invented) / max(reported - invented + missing, 1)
    if name in ("missing", "invented", "box_inflation"):
        return numbers(row[name])
    if name in ("inversions", "node_visits", "subsets", "segments_got", "pieces", "triangle_tests"):
        return float(row[name]) / later if row[name] else None
    return metric(name, row)


def spread(rows, who, name, per_object=False):
    """Median and quartiles over all repeats of a composition; None where it was not measured."""
    values = [
        value / (float(r["objects"]) if per_object else 1)
        for r in rows.of(who)
        if (value := value_of(name, r)) is not None
    ]
    if not values:
        return None
    return {"y": quantile(values, 0.5), "low": quantile(values, 0.25), "high": quantile(values, 0.75)}


def by_x(points):
    return sorted(points, key=lambda point: point["x"])


def line(conditions, x_of, who, name, per_object=False):
    """Medians and quartiles, a point per condition."""
    spreads = [(x_of(factors), spread(rows, who, name, per_object)) for factors, rows in conditions]
    return by_x([{"x": x, **found} for x, found in spreads if found])


def ratio_point(x, rows, arm, base, name):
    """The ratio of two compositions in the same repeat, with its 95 % interval; None where it was not measured."""
    cells = rows.log_ratios(arm, base, name)
    if not cells:
        return None
    low, value, high = limits(mean_ratio(rows.size(cells), cells))
    return {"x": x, "y": value, "low": low, "high": high}


def limits(estimate):
    value, error, degrees = estimate
    reach = error * student_quantile(degrees) if error > 0 else 0
    return tuple(math.exp(number) for number in (value - reach, value, value + reach))


def objects_of(factors):
    return float(factors["objects"])


def grouped(number):
    """With separators from four digits on."""
    return f"{int(number):,}"


# Figures of claims.


def conditions_of(results, experiment):
    """Those of an experiment that was not run are none."""
    is_there = (results.folder / experiment / "results.csv").exists()
    return results.conditions(experiment) if is_there else []


def of_factors(results, experiment, **wanted):
    return [
        (factors, rows)
        for factors, rows in conditions_of(results, experiment)
        if all(factors.get(name) == value for name, value in wanted.items())
    ]


def figure1(results):
    lines = Lines()
    drifting = of_factors(results, "figure1", scene="brownian", displacement="0.1")
    for label, who in {
        "insertion sort (traditional)": TRADITIONAL,
        "insertion sort, axial cut": {**TRADITIONAL, **AXIAL_CUT},
        "Shell sort": SHELL,
        "Shell sort, axial cut (improved)": IMPROVED,
        "insertion sort, incremental": {**TRADITIONAL, "sweep": "incremental"},
        "insertion sort, automatic grid": {**TRADITIONAL, "partition": "uniform_grid:cell_size=auto"},
    }.items():
        lines.add(label, line(drifting, objects_of, who, "frame_cpu_ms"))
    return lines


def c12(results):
    lines = Lines()
    drifting = of_factors(results, "figure1", scene="brownian", displacement="0.1")
    for label, who in {"no cut": SHELL, "axial cut": IMPROVED}.items():
        lines.add(label, line(drifting, objects_of, who, "box_tests"))
    return lines


def c2(results):
    lines = Lines()
    conditions = of_factors(results, "c2", displacement="0.1")
    for sort in SORTS:
        lines.add(sort, line(conditions, objects_of, {"sort": sort}, "work", per_object=True))
    lines.add("inversions", line(conditions, objects_of, {"sort": "insertion"}, "inversions", per_object=True))
    return lines


def c3(results):
    lines = Lines()
    for gaps in GAPS:
        for in_space in (True, False):
            points = []
            for factors, rows in conditions_of(results, "c3"):
                found = spread(rows, {"sort": "insertion"}, "inversions", per_object=True)
                if (factors["scene"] == "brownian") != in_space or not found or not found["y"] > 0:
                    continue
                point = ratio_point(
                    found["y"], rows, {"sort": "shell:gaps=" + gaps}, {"sort": "insertion"}, "update_cpu_ms"
                )
                points += [point] if point else []
            lines.add("in space" if in_space else "on a line", by_x(points), gaps)
    lines.add("insertion sort", [{"y": 1}])
    return lines


def c4(results, scene=None):
    rows = next(rows for factors, rows in conditions_of(results, "c4") if scene in (None, factors["scene"]))
    lines = Lines()
    for axes in (1, 2, 3):
        points = []
        for wanted in (2, 4, 8, 16, 32, 64, 256):
            cut = {**TRADITIONAL, "partition": f"axial_cut:axes={axes},segments={wanted}"}
            found = spread(rows, cut, "frame_cpu_ms")
            points += [{"x": wanted, **found}] if found else []
        lines.add(f"{axes} ax{'i' if axes == 1 else 'e'}s", points)
    uncut = spread(rows, TRADITIONAL, "frame_cpu_ms")
    lines.add("no cut", [uncut] if uncut else [])
    return lines


def c5(results):
    lines = Lines()
    for factors, rows in conditions_of(results, "c5"):
        points = []
        for size in CELL_SIZES:
            point = ratio_point(float(size), rows, grid(size), CUT, "frame_cpu_ms")
            subsets = spread(rows, grid(size), "subsets")
            if point and not (subsets and subsets["y"] <= 1):
                points.append(point)
        lines.add(factors["scene"], points, grouped(factors["objects"]) + " objects")
    lines.add("axial cut", [{"y": 1}])
    return lines


def c5_world(results, name):
    def side(factors):
        return (float(factors["objects"]) / float(factors["density"])) ** (1 / 3)

    lines = Lines()
    for label, who in {"grid, cells of 2": grid("2"), "grid, auto": grid("auto"), "axial cut": CUT}.items():
        lines.add(label, line(conditions_of(results, "c5_world"), side, who, name))
    return lines


def c6(results):
    times = {}
    for process in itertools.count():
        file = results.folder / "c6" / f"process-{process}.json"
        if not file.exists():
            break
        for run in json.loads(file.read_text(encoding="utf-8"))["benchmarks"]:
            if run.get("run_type") == "iteration":
                unit = {"us": 1e3, "ms": 1e6}.get(run.get("time_unit"), 1)
                times.setdefault(run["run_name"], []).append(run["cpu_time"] * unit)
    lines = Lines()
    tests = sorted(name for name in times if not name.endswith("/frame:a"))
    for label, suffix in {
        "with the transformation from B's frame to A's": "",
        "without a transformation": "/frame:a",
    }.items():
        points = []
        for y, name in enumerate(tests):
            values = times.get(name + suffix)
            if values:
                low, median, high = (quantile(values, share) for share in (0.25, 0.5, 0.75))
                points.append({"x": median, "y": -y, "x_low": low, "x_high": high})
        lines.add(label, points)
    return lines


def size_figure(results, name):
    conditions = []
    for experiment in ("figure2", "figure2_million"):
        conditions += [c for c in conditions_of(results, experiment) if c[0]["meshes"].startswith("noise_sphere")]
    lines = Lines()
    for label, tree in {
        "canonical": "canonical",
        "leafless": "leafless:leaf_test=triangle_box",
        "shared planes": "shared_planes",
        "compressed": "compressed:leaf_test=triangle_box",
    }.items():
        points = []
        for _, rows in conditions:
            found = spread(rows, {"tree": tree}, name)
            points += [{"x": float(rows.rows[0]["triangles"]), **found}] if found else []
        lines.add(label, by_x(points))
    return lines


def c8(results):
    lines = Lines()
    for build in ("mean", "midpoint", "sah"):
        points = []
        for x, (_, rows) in enumerate(conditions_of(results, "table1")):
            canonical = {"tree": "canonical", "build": "median"}
            point = ratio_point(x, rows, canonical, {**canonical, "build": build}, "detect_cpu_ms")
            points += [point] if point else []
        lines.add("over " + build, points)
    lines.add("equal", [{"y": 1}])
    return lines


def by_span(results, experiment, arm, base, is_compared, level):
    lines = Lines()
    spans = {}
    for factors, rows in conditions_of(results, experiment):
        point = ratio_point(float(factors["huge"]), rows, arm, base, "frame_cpu_ms") if "span" in factors else None
        if point and is_compared(rows):
            spans.setdefault(factors["span"], []).append(point)
    for span in sorted(spans):
        lines.add(f"edge {span} of the world", spans[span])
    lines.add(level, [{"y": 1}])
    return lines


def c9(results):
    split = {"prepare": "split_large:size=4"}
    return by_span(
        results, "c9", split, {"prepare": "none"}, lambda rows: spread(rows, split, "pieces")["y"] > 0, "not split"
    )


def c10(results):
    def limit(word):
        return {"partition": f"axial_cut:axes=2,limit={word},segments=auto"}

    def acts(rows):
        got = [spread(rows, limit(word), "segments_got") for word in ("on", "off")]
        return None in got or got[0]["y"] != got[1]["y"]

    return by_span(results, "c10", limit("on"), limit("off"), acts, "any number of cuts")


def c11(results):
    conditions = conditions_of(results, "c11")
    simple = [c for c in conditions if c[0]["meshes"] == conditions[-1][0]["meshes"]]
    lines = Lines()
    for label, who, tree in (
        ("traditional in both phases", TRADITIONAL, "canonical"),
        ("improved broad phase", IMPROVED, "canonical"),
        ("improved narrow phase", TRADITIONAL, "compressed:leaf_test=triangle_box"),
        ("improved in both", IMPROVED, "compressed:leaf_test=triangle_box"),
    ):
        lines.add(label, line(simple, objects_of, {**who, "tree": tree}, "frame_cpu_ms"))
    return lines


def smb(results):
    lines = Lines()
    for label, who in {"every axis cut": {**SHELL, "partition": "axial_cut:axes=3"}, "no cut": SHELL}.items():
        lines.add(label, line(conditions_of(results, "smb_objects"), objects_of, who, "frame_cpu_ms", per_object=True))
    return lines


CLAIM_FIGURES = {
    "figure1": figure1,
    "figure2": lambda results: size_figure(results, "detect_cpu_ms"),
    "figure2_bytes": lambda results: size_figure(results, "tree_bytes"),
    "c2": c2,
    "c3": c3,
    "c4": c4,
    "c4_clustered": lambda results: c4(results, "clustered"),
    "c5": c5,
    "c5_world": lambda results: c5_world(results, "bytes"),
    "c5_world_time": lambda results: c5_world(results, "frame_cpu_ms"),
    "c6": c6,
    "c8": c8,
    "c9": c9,
    "c10": c10,
    "c11": c11,
    "c12": c12,
    "smb": smb,
}


# Figures of error against run time.


def front_of(points):
    """Those that no other beats in one and equals or beats in the other, of equal ones the first."""
    front = []
    for point in sorted(points):
        if not front or point[1] < front[-1][1]:
            front.append(point)
    return [{"x": x, "y": y} for x, y in front]


def file_name(text):
    return re.sub(r"[^a-zA-Z0-9_]", "-", text)[:100]


def interval_of(cells):
    """The 95 % interval of a median over repeats, or None where there are too few."""
    if not cells:
        return None
    size = (
        1 + max(process for process, _ in cells),
        1 + max(seed for _, seed in cells),
        max(len(cell) for cell in cells.values()),
    )
    value, error, degrees = bootstrap(size, lambda draw: draw.mean(cells))
    if not error > 0 or degrees <= 2:
        return None
    low, _, high = limits((value, error, degrees))
    return low, high


def wilson(wrong, pairs):
    z = 1.959963984540054
    share = wrong / pairs
    middle = (share + z * z / (2 * pairs)) / (1 + z * z / pairs)
    half = z / (1 + z * z / pairs) * math.sqrt(share * (1 - share) / pairs + z * z / (4 * pairs * pairs))
    return max(0.0, middle - half), middle + half


def wrong_of(row):
    return int(row["false_negatives"]) + int(row["false_positives"])


def share_of(row):
    return wrong_of(row) / int(row["count"])


def time_of(row):
    return float(row.get("cpu_ns") or row["ns"])


def lines_of_tests(lines, rows, is_sample, panel=""):
    """Of the tests of triangles on some sets: the mean time, and the error where it is greatest."""
    methods = {}
    for row in rows:
        methods.setdefault((row["curve"], row["triangle"]), []).append(row)
    least = 1 / min(int(row["count"]) for row in rows)
    costs, curves = [], {}
    for (curve, _), sets in methods.items():
        worst = max(sets, key=share_of)
        x = sum(map(time_of, sets)) / len(sets)
        point = {"x": x, "y": max(least, share_of(worst))}
        if all(row.get("cpu_ns_low") for row in sets):
            below = sum((float(row["cpu_ns"]) - float(row["cpu_ns_low"])) ** 2 for row in sets)
            above = sum((float(row["cpu_ns_high"]) - float(row["cpu_ns"])) ** 2 for row in sets)
            point.update(x_low=x - math.sqrt(below) / len(sets), x_high=x + math.sqrt(above) / len(sets))
        if wrong_of(worst) and is_sample:
            point["low"], point["high"] = wilson(wrong_of(worst), int(worst["count"]))
        costs.append((x, share_of(worst)))
        curves.setdefault(curve, []).append(point)
    lines.add(FRONT, [{**point, "y": max(least, point["y"])} for point in front_of(costs)], panel)
    for curve, points in curves.items():
        lines.add(curve, points, panel)
    lines.add("no errors (1/N to 3/N)", [{"y": least, "low": least, "high": 3 * least}], panel)


def figures_of_tests(study):
    with open(study / "errors.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    # Scenes have parameters, classes of generated pairs are single words.
    groups = {
        "errors_meshes": [row for row in rows if " " in row["pairs"]],
        "errors_float": [row for row in rows if " " not in row["pairs"] and row["precision"] == "float"],
        "errors_double": [row for row in rows if " " not in row["pairs"] and row["precision"] == "double"],
    }
    figures = {}
    for name, of_group in groups.items():
        if not any(map(wrong_of, of_group)):
            continue
        lines = figures[name] = Lines()
        if name != "errors_meshes":
            lines_of_tests(lines, of_group, is_sample=True)
            continue
        for number, scene in enumerate(dict.fromkeys(row["pairs"] for row in of_group), 1):
            of_scene = [row for row in of_group if row["pairs"] == scene]
            if any(map(wrong_of, of_scene)):
                lines_of_tests(lines, of_scene, is_sample=False, panel=f"scene {number}")
    return figures


def choices_in(value):
    """The strategies that an entry of a config lists, as rows name them."""
    if isinstance(value, list):
        return [choice for item in value for choice in choices_in(item)]
    if isinstance(value, str):
        return [value]
    names = value["name"] if isinstance(value["name"], list) else [value["name"]]
    keys = [key for key in value if key != "name"]
    lists = [value[key] if isinstance(value[key], list) else [value[key]] for key in keys]
    found = []
    for name in names:
        for values in itertools.product(*lists):
            settings = ",".join(f"{key}={text_of(v)}" for key, v in zip(keys, values))
            found.append(name + (":" + settings if settings else ""))
    return found


def text_of(value):
    return f"{value:g}" if isinstance(value, float) else str(value)


def curves_of(study):
    """The points of each curve with what must be in their rows, and the metrics of the plots."""
    if (study / "curves.csv").exists():
        with open(study / "curves.csv", newline="", encoding="utf-8") as file:
            points = [(row["curve"], {k: row[k] for k in KINDS if row[k]}) for row in csv.DictReader(file)]
        with open(study / "plots.csv", newline="", encoding="utf-8") as file:
            return points, [(row["x"], row["y"]) for row in csv.DictReader(file)]
    # Results of earlier versions have their config instead; only what it names is in it.
    config = tomllib.loads((study / "config.toml").read_text(encoding="utf-8"))
    points = []
    for curve in config["curve"]:
        kinds = [kind for kind in KINDS if kind in curve]
        for choices in itertools.product(*(choices_in(curve[kind]) for kind in kinds)):
            points.append((curve["label"], dict(zip(kinds, choices))))
    return points, [(plot["x"], plot["y"]) for plot in config["plot"]]


ERRORS = ("wrong_share", "missing", "invented", "box_inflation")


class Method:
    """The rows of a composition in one scene."""

    def __init__(self, rows):
        self.rows = rows

    def value(self, name):
        values = [value for r in self.rows if (value := value_of(name, r)) is not None]
        if not values:
            return None
        return sum(values) / len(values) if name in ERRORS else median(values)

    def interval(self, name):
        if not name.endswith("ms"):
            return None
        seeds, processes = [], []
        for r in self.rows:
            seeds += [r["seed"]] if r["seed"] not in seeds else []
            processes += [r["process"]] if r["process"] not in processes else []
        cells = Cells()
        for r in self.rows:
            if (value := value_of(name, r)) and value > 0:
                place = processes.index(r["process"]), seeds.index(r["seed"])
                cells.setdefault(place, []).append(math.log(value))
        return interval_of(cells)


def lines_of_plot(points, rows, x_name, y_name):
    """A curve per method over its parameter, in one scene; None where nothing errs."""
    curves, costs = {}, []
    for curve, wanted in points:
        method = Method([r for r in rows if not r["engine"] and all(r[k] in ("", v) for k, v in wanted.items())])
        x, y = method.value(x_name), method.value(y_name)
        if x is None or y is None:
            continue
        point = {"x": x, "y": y}
        if found := method.interval(x_name):
            point["x_low"], point["x_high"] = found
        if found := method.interval(y_name):
            point["low"], point["high"] = found
        curves.setdefault(curve, []).append(point)
        costs.append((x, y))
    lines = Lines()
    are_errors = y_name in ERRORS
    if costs and are_errors and not any(y for _, y in costs):
        return None
    lines.add(FRONT, front_of(costs))
    for curve, of_curve in curves.items():
        lines.add(curve, of_curve)
    floor = None
    if y_name == "wrong_share":
        any_row = rows[0]
        exact = sum(
            float(r["contacts"] or r["candidates"]) + float(r["missing"] or 0) - float(r["invented"] or 0)
            for r in {r["seed"]: r for r in rows if all(r[k] == any_row[k] for k in [*KINDS, "engine"])}.values()
        )
        floor = 1 / exact if exact > 0 else None
    elif are_errors and any(not y for _, y in costs):
        floor = min(y for _, y in costs if y) / 3
    if floor:
        for of_curve in lines.values():
            for point in of_curve:
                if point["y"] < floor:
                    point["y"] = floor
        lines.add("no errors (1/N)" if y_name == "wrong_share" else "zero", [{"y": floor}])
    return lines


def figures_of_compositions(study):
    points, plots = curves_of(study)
    scenes = {}
    with open(study / "results.csv", newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            settings = json.loads(row["scene_parameters"], parse_float=str, parse_int=str)
            texts = [f"{k}={'+'.join(v) if k == 'meshes' else v}" for k, v in settings.items()]
            scenes.setdefault(" ".join([row["scene"], *texts]), []).append(row)
    figures = {}
    for title, rows in scenes.items():
        for x, y in plots:
            lines = lines_of_plot(points, rows, x, y)
            name = file_name(f"{y}_over_{x}_{title}")
            while name in figures:
                name += "-again"
            if lines:
                figures[name] = lines
    return figures


def error_figures(folder):
    figures = {}
    for study in sorted((folder / "errors").iterdir() if (folder / "errors").is_dir() else []):
        if (study / "errors.csv").exists():
            figures.update(figures_of_tests(study))
        elif (study / "results.csv").exists():
            figures.update(figures_of_compositions(study))
    return figures


# Comparison.


def figures_of_reports(folder):
    """Those of suites of which earlier versions kept a report only, by name, and why they cannot be recomputed."""
    reports = [folder / suite / "report.json" for suite in ("extreme", "stiff")]
    return {
        f["name"]: f"{file.parent.name}/report.json, of an earlier version, has no rows"
        for file in reports
        if file.exists()
        for f in json.loads(file.read_text(encoding="utf-8"))["figures"]
    }


def check(report, results, verdicts, differs):
    """Compares every figure, of which `verdicts` is recomputed already; calls `differs` with a sentence per difference."""
    figures = report / "figures"
    of_claims = re.findall(r"^\\aabbset\{\w+\.figures\}\{(.*)\}$", (report / "macros.tex").read_text(), re.MULTILINE)
    wanted = {"verdicts": verdicts}
    for name in filter(None, ",".join(of_claims).split(",")):
        if name in CLAIM_FIGURES:
            wanted[name] = CLAIM_FIGURES[name](results)
        else:
            differs(f"{name} is a figure of a claim, and is not recomputed")
    wanted.update(error_figures(results.folder))
    wanted.update(stiff_figures(results.folder / "stiff", differs))
    of_atlas, without_rows = atlas_figures(results.folder / "atlas")
    wanted.update(of_atlas)
    without_rows.update(figures_of_reports(results.folder))
    points = 0
    for name, lines in wanted.items():
        if not (figures / f"{name}.csv").exists():
            differs(f"{name} is not drawn")
            continue
        points += sum(map(len, lines.values()))
        for sentence in differences_of(name, lines, drawn(figures / f"{name}.csv")):
            differs(sentence)
    for name in sorted({file.stem for file in figures.glob("*.csv")} - set(wanted) - set(without_rows)):
        differs(f"{name} is drawn, but rows have no such figure")
    reasons = {}
    for name, why in sorted(without_rows.items()):
        reasons.setdefault(why, []).append(name)
    not_recomputed = "; ".join(f"{', '.join(names)} ({why})" for why, names in reasons.items()) or "none"
    print(f"{len(wanted)} figures with {points} points recomputed; not recomputed: {not_recomputed}")
