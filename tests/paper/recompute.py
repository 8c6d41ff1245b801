#!/usr/bin/env python3
"""Recomputes the verdicts of a reproduction from its rows, without any code of the program that judged them.

recompute.py REPORT [ARCHIVE]: reads results.csv of every experiment and c6/process-N.json, from the folder REPORT or from
an archive, computes every ratio that REPORT/endpoints.csv names with its interval, decides it by the rule of
paper/claims/endpoints.toml, which also says which ratios decide which claim and how, and compares with what endpoints.csv
and verdicts.csv say; then every figure, with recompute_figures.py, recompute_stiff.py and recompute_atlas.py. Ends with 1
where a number differs in its third digit, or a verdict or a figure differs.
"""

import csv
import functools
import itertools
import json
import math
import pathlib
import re
import sys
import tarfile
import tempfile
import tomllib

if __name__ == "__main__":
    # The module under its own name, so that both files share one copy of its functions.
    sys.modules["recompute"] = sys.modules["__main__"]

# What decides each claim, fixed before the measurements.
STATED = tomllib.loads(
    (pathlib.Path(__file__).resolve().parents[2] / "paper" / "claims" / "endpoints.toml").read_text(encoding="utf-8")
)
MARGIN = math.log1p(STATED["rule"]["margin"])
ONE_SIDED = STATED["rule"]["level"]
DRAWS = 1000
KINDS = ["prepare", "sort", "partition", "sweep", "build", "tree", "triangle"]
MASK = (1 << 64) - 1


# SplitMix64 (Steele, Lea, Flood 2014), since the same data give the same draws.
def splitmix(state):
    state = (state + 0x9E3779B97F4A7C15) & MASK
    z = state
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
    return state, z ^ (z >> 31)


class Stream:
    """The numbers that follow a state."""

    def __init__(self, state):
        self.state, self.numbers = state, []

    def first(self, count):
        while len(self.numbers) < count:
            self.state, number = splitmix(self.state)
            self.numbers.append(number)
        return self.numbers[:count]


# Every statistic draws from the same states.
stream = functools.cache(Stream)


def median(values):
    """As statistics.median and ten times as fast."""
    values = sorted(values)
    half = len(values) // 2
    return values[half] if len(values) % 2 else (values[half - 1] + values[half]) / 2


def variance_of(values):
    """As statistics.variance, which computes in fractions."""
    mean = math.fsum(values) / len(values)
    return math.fsum((value - mean) ** 2 for value in values) / (len(values) - 1)


class Cells(dict):
    """Logarithms of what was measured, a list of repeats by process and seed."""

    @functools.cached_property
    def medians(self):
        return {place: median(cell) for place, cell in self.items()}


class Draw:
    """One level drawn anew: "none", "processes", "seeds" or "repeats"."""

    def __init__(self, processes, seeds, level, state):
        self.level, self.state = level, state
        self.processes = self.places(processes, level == "processes")
        self.seeds = self.places(seeds, level == "seeds")
        self.means = {}

    def places(self, count, drawn):
        return [number % count for number in stream(self.state).first(count)] if drawn else range(count)

    def mean(self, cells):
        """Over cells, the mean of the medians of their repeats."""
        if id(cells) not in self.means:
            places = [(p, s) for p in self.processes for s in self.seeds if (p, s) in cells]
            if self.level == "repeats":
                medians = self.medians_of_repeats([cells[place] for place in places])
            else:
                medians = [cells.medians[place] for place in places]
            self.means[id(cells)] = sum(medians) / len(medians) if medians else math.nan
        return self.means[id(cells)]

    def medians_of_repeats(self, cells):
        numbers = iter(stream(self.state).first(sum(map(len, cells))))
        return [median([cell[next(numbers) % len(cell)] for _ in cell]) for cell in cells]


def bootstrap(size, statistic):
    """Value, standard error and degrees of freedom."""
    processes, seeds, repeats = size
    value = statistic(Draw(processes, seeds, "none", 0))

    def variance(level, count):
        if count < 2:
            return 0.0
        drawn = [statistic(Draw(processes, seeds, level, state)) for state in stream(1).first(DRAWS)]
        values = [value for value in drawn if math.isfinite(value)]
        return variance_of(values) * count / (count - 1) if len(values) > 1 else 0.0

    noise = variance("repeats", repeats)
    of_processes, of_seeds = variance("processes", processes), variance("seeds", seeds)
    parts = [
        (max(0.0, of_processes - noise), of_processes, processes - 1),
        (max(0.0, of_seeds - noise), of_seeds, seeds - 1),
        (noise, noise, processes * seeds * (repeats - 1)),
    ]
    total = sum(part for part, _, _ in parts)
    if total <= 0:
        return value, 0.0, 1.0
    below = sum(seen * seen / degrees for part, seen, degrees in parts if part > 0 and degrees > 0)
    return value, math.sqrt(total), total * total / below


def beta_fraction(a, b, x):
    """The continued fraction of the incomplete beta function, by Lentz's method."""
    tiny = 1e-300
    c, d = 1.0, 1 - (a + b) * x / (a + 1)
    d = 1 / (d if abs(d) > tiny else tiny)
    found = d
    for m in range(1, 10000):
        for n in (
            m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
            -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1)),
        ):
            d = 1 + n * d
            d = 1 / (d if abs(d) > tiny else tiny)
            c = 1 + n / c
            c = c if abs(c) > tiny else tiny
            found *= d * c
        if abs(d * c - 1) < 1e-15:
            break
    return found


def beta(a, b, x):
    if x <= 0 or x >= 1:
        return 0.0 if x <= 0 else 1.0
    front = math.exp(
        math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b) + a * math.log(x) + b * math.log(1 - x)
    )
    if x < (a + 1) / (a + b + 2):
        return front * beta_fraction(a, b, x) / a
    return 1 - front * beta_fraction(b, a, 1 - x) / b


def student_above(t, degrees):
    """The chance of a greater value."""
    tail = beta(degrees / 2, 0.5, degrees / (degrees + t * t)) / 2
    return tail if t >= 0 else 1 - tail


def student_quantile(degrees):
    low, high = 0.0, 1e6
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if student_above(middle, degrees) > ONE_SIDED else (low, middle)
    return (low + high) / 2


def chance_above(estimate, limit):
    value, error, degrees = estimate
    return student_above((limit - value) / error, degrees) if error > 0 else float(value >= limit)


def chance_below(estimate, limit):
    value, error, degrees = estimate
    return student_above((value - limit) / error, degrees) if error > 0 else float(value <= limit)


# Rows.


def numbers(text):
    return float(text) if text else None


def factors_of(row):
    settings = json.loads(row["scene_parameters"])
    found = {"scene": row["scene"]}
    for name, value in settings.items():
        if name == "frames":
            continue
        if name == "meshes":
            value = "+".join(value)
        found[name] = value if isinstance(value, str) else f"{value:g}" if isinstance(value, float) else str(value)
    return found


def metric(name, row):
    frames = int(row["frames"])
    later = max(frames - 1, 1)
    if name == "tree_bytes":
        parts = [numbers(row["bytes_nodes"]), numbers(row["bytes_indices"])]
        return None if None in parts else sum(parts)
    if name == "box_tests":
        return numbers(row["box_tests"]) / later
    if name == "work":
        return (numbers(row["comparisons"]) + (numbers(row["moves"]) or 0)) / later
    if name == "bytes":  # of global search
        parts = [numbers(row["bytes_" + part]) for part in ("projections", "partition", "sweep")]
        return sum(part or 0 for part in parts)
    if name == "global_cpu_ms":
        return sum(float(row[part + "_cpu_ms"]) for part in ("update", "search")) / later if frames > 1 else None
    if name == "frame_cpu_ms":
        if not row["update_cpu_ms"] or frames == 1:
            return numbers(row["first_cpu_ms"])
        return sum(float(row[part + "_cpu_ms"]) for part in ("update", "search", "detect")) / later
    return float(row[name]) / later if frames > 1 else None


def choices_of(text):
    found = {}
    for word in text.split():
        name, _, value = word.partition("=")
        found[name] = value
    return found


def named_now(choice):
    """Results of before axial_cut chose the number of axes itself name none where two were cut."""
    if not choice.startswith("axial_cut") or "axes=" in choice:
        return choice
    return "axial_cut:axes=2" + choice.removeprefix("axial_cut").replace(":", ",", 1)


class Rows:
    """The rows of one condition."""

    def __init__(self, rows):
        self.rows = rows
        self.seeds = sorted({int(r["seed"]) if r["seed"] else -1 for r in rows})
        self.processes = max(int(r["process"]) for r in rows) + 1

    def of(self, who):
        return [
            r
            for r in self.rows
            if not r["engine"] and r["status"] == "exact" and all(v in (r[k], named_now(r[k])) for k, v in who.items())
        ]

    def place(self, row):
        return int(row["process"]), self.seeds.index(int(row["seed"]) if row["seed"] else -1)

    def logs(self, who, name, an_object=False):
        found = Cells()
        for r in self.of(who):
            value = metric(name, r)
            if value:
                found.setdefault(self.place(r), []).append(
                    math.log(value / (float(r["objects"]) if an_object else 1))
                )
        return found

    def log_ratios(self, arm, base, name):
        against = {(r["seed"], r["repeat"]): r for r in self.of(base)}
        found = Cells()
        for r in self.of(arm):
            other = against.get((r["seed"], r["repeat"]))
            value, below = metric(name, r), other and metric(name, other)
            if value and below:
                found.setdefault(self.place(r), []).append(math.log(value / below))
        return found

    def size(self, cells):
        return self.processes, len(self.seeds), max(len(cell) for cell in cells.values())


class Results:
    def __init__(self, folder):
        self.folder = folder
        self.read = {}

    def conditions(self, experiment):
        if experiment not in self.read:
            groups = {}
            with open(self.folder / experiment / "results.csv", newline="", encoding="utf-8") as file:
                for row in csv.DictReader(file):
                    groups.setdefault(json.dumps(factors_of(row)), []).append(row)
            self.read[experiment] = [(json.loads(key), Rows(rows)) for key, rows in groups.items()]
        return self.read[experiment]

    def condition(self, experiment, where):
        for factors, rows in self.conditions(experiment):
            if all(where.get(name) == value for name, value in factors.items()):
                return rows
        # A claim that tells its places by other names has the meshes among them.
        for factors, rows in self.conditions(experiment):
            if "meshes" in where and factors.get("meshes") == where["meshes"]:
                return rows
        raise SystemExit(f"{experiment} has no condition {where}")


def mean_ratio(size, cells):
    return bootstrap(size, lambda draw: draw.mean(cells))


def ratio(results, experiment, text, where):
    name, _, arms = text.partition(" of ")
    arm, _, base = arms.partition(" over ")
    rows = results.condition(experiment, where)
    cells = rows.log_ratios(choices_of(arm), choices_of(base), name)
    return mean_ratio(rows.size(cells), cells)


def growth_of_work(results, sort, where):
    """What the straight line through work an element against log N adds at ten times as many, of C2."""
    sizes = []
    inversions = []
    for factors, rows in results.conditions("c2"):
        n = float(factors["objects"])
        if factors["displacement"] == where["displacement"] and n >= 10000:
            sizes.append((math.log10(n), rows.logs({"sort": sort}, "work", True), rows))
            inversions.append(median(metric("inversions", r) / n for r in rows.of({"sort": "insertion"})))
    # Of input that is more ordered than at other sizes nothing is learnt about growth.
    usual = median(inversions)
    sizes = [size for size, found in zip(sizes, inversions) if abs(found - usual) <= 0.1 * usual]

    def growth(draw):
        x = [log_n for log_n, _, _ in sizes]
        y = [math.exp(draw.mean(cells)) for _, cells, _ in sizes]
        mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
        slope = sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)
        return math.log(max(1e-6, 1 + slope / mean_y))

    _, cells, rows = sizes[0]
    return bootstrap(rows.size(cells), growth)


CUT = {"sort": "insertion", "partition": "axial_cut:axes=2", "sweep": "one_axis"}
CELL_SIZES = ["4", "8", "16", "32", "64"]


def grid(size):
    return {"sort": "insertion", "partition": "uniform_grid:cell_size=" + size, "sweep": "one_axis"}


def regret(results, where):
    """The worst slowdown of the cut over scenes of as many objects, over that of the best single cell size, of C5b. A
    slowdown is over the scene's best cell size."""
    scenes = [rows for factors, rows in results.conditions("c5") if factors["objects"] == where["objects"]]

    def is_grid(rows, size):
        made = [float(r["subsets"]) / max(int(r["frames"]) - 1, 1) for r in rows.of(grid(size)) if r["subsets"]]
        return not made or median(made) > 1

    over_cut = [
        {size: rows.log_ratios(grid(size), CUT, "frame_cpu_ms") for size in CELL_SIZES if is_grid(rows, size)}
        for rows in scenes
    ]
    sizes = [size for size in CELL_SIZES if all(size in scene for scene in over_cut)]

    def worst(draw, size):
        found = []
        for scene in over_cut:
            best = min(draw.mean(cells) for cells in scene.values())
            found.append((0 if size is None else draw.mean(scene[size])) - best)
        return max(found)

    def statistic(draw):
        return worst(draw, None) - min(worst(draw, size) for size in sizes)

    return bootstrap(scenes[0].size(over_cut[0][sizes[0]]), statistic)


def growth_with_world(results, where):
    conditions = results.conditions("c5_world")
    small, large = conditions[0][1], conditions[-1][1]
    what = where["comparison"]
    if what.startswith("bytes of axial_cut"):
        above, below = large.logs(CUT, "bytes"), small.logs(CUT, "bytes")
    else:
        who = grid("2" if "cells of 2" in what else "auto")
        if what.startswith("time"):
            above, below = (rows.log_ratios(who, CUT, "frame_cpu_ms") for rows in (small, large))
        else:
            above, below = (rows.logs(who, "bytes") for rows in (small, large))
    size = small.size(above)
    return bootstrap(size, lambda draw: draw.mean(above) - draw.mean(below))


def between_conditions(results, experiment, text, where):
    """Time or bytes an object over those at the least value of a factor, of SMB's claim."""
    name, _, who = text.partition(" an object of ")
    factor, _, value = where["over"].partition(" ")
    place = {k: v for k, v in where.items() if k not in ("over", "quantity")}
    large = results.condition(experiment, place)
    small = results.condition(experiment, {**place, factor: value})
    above, below = (rows.logs(choices_of(who), name, True) for rows in (large, small))
    return bootstrap(large.size(above), lambda draw: draw.mean(above) - draw.mean(below))


def of_tests(folder, text):
    arm, _, base = text.partition(" over ")
    cells = Cells()
    for process in range(1000):
        file = folder / "c6" / f"process-{process}.json"
        if not file.exists():
            break
        times = {}
        for one in json.loads(file.read_text(encoding="utf-8"))["benchmarks"]:
            if one.get("run_type") == "iteration":
                unit = {"us": 1e3, "ms": 1e6}.get(one.get("time_unit"), 1)
                times.setdefault(one["run_name"], []).append(one["cpu_time"] * unit)
        cells[process, 0] = [math.log(a / b) for a, b in zip(times[arm], times[base])]
    return mean_ratio((len(cells), 1, max(len(cell) for cell in cells.values())), cells)


def is_measured(results, ratio):
    """Whether the rows have a stated ratio, which names only some factors of its condition."""
    experiment = ratio["source"].partition(": ")[0]
    wheres = [ratio["where"]]
    if (results.folder / experiment / "results.csv").exists():
        for factors, _ in results.conditions(experiment):
            if all(ratio["where"].get(name, value) == value for name, value in factors.items()):
                wheres.append({**factors, **ratio["where"]})
    for where in wheres:
        text = "; ".join(f"{name}={value}" for name, value in where.items())
        try:
            if math.isfinite(estimate_of(results, {"source": ratio["source"], "where": text})[0]):
                return True
        except (SystemExit, OSError, KeyError, ValueError, IndexError):
            pass
    return False


def estimate_of(results, endpoint):
    experiment, _, text = endpoint["source"].partition(": ")
    where = where_of(endpoint)
    if experiment == "c6":
        return of_tests(results.folder, text)
    if text.startswith("growth of comparisons"):
        return growth_of_work(results, text.rpartition(" of sort=")[2], where)
    if text == "regret":
        return regret(results, where)
    if text == "growth":
        return growth_with_world(results, where)
    if " an object of " in text:
        return between_conditions(results, experiment, text, where)
    return ratio(results, experiment, text, where)


# The rule.


def stated_ratios(claim, role):
    """The ratios of a claim that decide it ("primary"), or did ("earlier"): lists multiply out, {names} are replaced."""
    for entry in claim.get(role, []):
        for table in entry["where"]:
            lists = [value if isinstance(value, list) else [value] for value in table.values()]
            for values in itertools.product(*lists):
                where = dict(zip(table, values))
                names = {**STATED["arms"], **where}
                yield {
                    "source": re.sub(r"{(\w+)}", lambda name: names[name[1]], entry["ratio"]),
                    "where": where,
                    "expected": entry.get("expects", claim["expects"]),
                }


def where_of(endpoint):
    return dict(part.split("=", 1) for part in endpoint["where"].split("; "))


def is_this(endpoint, ratio):
    where = where_of(endpoint)
    return endpoint["source"] == ratio["source"] and all(
        where.get(name, "") == value for name, value in ratio["where"].items()
    )


def tails(estimate):
    return {
        "less": chance_above(estimate, -MARGIN),
        "not less": chance_below(estimate, -MARGIN),
        "not more": chance_above(estimate, MARGIN),
        "more": chance_below(estimate, MARGIN),
    }


def margin_test(e):
    """The chances of the measurement if it were not for the claim, and if it were not against it."""
    return [e["p"][name] for name in (("less", "not less") if e["expected"] == "less" else ("not more", "more"))]


def holm(endpoints):
    order = sorted(range(len(endpoints)), key=lambda i: (min(margin_test(endpoints[i])), i))
    for e in endpoints:
        e["level"] = 0.0
    for done, i in enumerate(order):
        level = ONE_SIDED / (len(order) - done)
        if min(margin_test(endpoints[i])) > level:
            break
        endpoints[i]["level"] = level


def direction(e):
    p, level = e["p"], e["level"]
    if p["less"] <= level or p["more"] <= level:
        return "less" if p["less"] <= level else "more"
    return "same" if p["not less"] <= level and p["not more"] <= level else "open"


def outcome(e):
    for_it, against_it = (p <= e["level"] for p in margin_test(e))
    if for_it or not against_it:
        return "for" if for_it else "undecided"
    return "no difference" if e["expected"] == "less" and e["p"]["not more"] <= e["level"] else "against"


def verdict(rule, outcomes):
    """Of the outcomes of all primary ratios, those that were not measured being undecided."""
    found = set(outcomes)
    otherwise = found & {"against", "no difference"}
    if rule == "every" and ("against" in found or ("for" in found and otherwise)):
        return "does not hold"
    if "for" in found and otherwise:
        return "holds in part"
    if not found or "undecided" in found:
        return "undecided"
    return {("for",): "holds", ("no difference",): "no difference"}.get(tuple(found), "does not hold")


def verdict_lines(claims, endpoints, primaries):
    """The figure of all primary ratios, by claim and outcome."""
    labels = {
        "for": "for the claim",
        "against": "against it",
        "no difference": "no difference",
        "undecided": "undecided",
    }
    lines = recompute_figures.Lines()
    for x, claim in enumerate(claims):
        for e in endpoints:
            if any(e is primary for primary in primaries[claim]):
                lines.add(labels[outcome(e)], [{"x": x, **e["limits"]}])
    margin = math.exp(MARGIN)
    lines.add("band of no difference", [{"y": 1, "low": 1 / margin, "high": margin}])
    return lines


def agree(a, b):
    """To three digits: by less than one unit of the third."""
    return a == b or abs(a - b) < 10 ** (math.floor(math.log10(max(abs(a), abs(b), 1e-300))) - 2)


def recompute(folder, results):
    with open(folder / "endpoints.csv", newline="", encoding="utf-8") as file:
        endpoints = list(csv.DictReader(file))
    with open(folder / "verdicts.csv", newline="", encoding="utf-8") as file:
        verdicts = [list(row.values()) for row in csv.DictReader(file)]
    differences = 0

    def differs(text):
        nonlocal differences
        differences += 1
        print(text)

    for e in endpoints:
        value, error, degrees = estimate_of(results, e)
        reach = error * student_quantile(degrees) if error > 0 else 0
        e["p"] = tails((value, error, degrees))
        e["limits"] = {name: math.exp(value + by) for name, by in (("y", 0), ("low", -reach), ("high", reach))}
        for name, mine in zip(("ratio", "low", "high"), e["limits"].values()):
            if not agree(mine, float(e[name])):
                differs(f"{e['claim']} {e['where']}: {name} is {mine:.4g}, not {e[name]}")
    # The roles of ratios and what they expect, from what was stated before the measurements.
    told = {row[0]: row[2] for row in verdicts}
    primaries = {}
    missing = {}
    for claim in STATED["claim"]:
        of_claim = [e for e in endpoints if e["claim"] == claim["id"]]
        primaries[claim["id"]] = []
        missing[claim["id"]] = 0
        for ratio in stated_ratios(claim, "primary"):
            rows = [e for e in of_claim if is_this(e, ratio)]
            if len(rows) > 1:
                differs(f"{claim['id']} has {len(rows)} ratios {ratio}")
            if not rows:
                missing[claim["id"]] += 1
                if is_measured(results, ratio):
                    differs(f"{claim['id']} {ratio['where']} was measured, and is left out")
            for e in rows:
                if e["expected"] != ratio["expected"]:
                    differs(f"{claim['id']} {e['where']} expects {ratio['expected']}, not {e['expected']}")
            primaries[claim["id"]] += rows
        earlier = [e for ratio in stated_ratios(claim, "earlier") for e in of_claim if is_this(e, ratio)]
        for e in of_claim:
            is_primary = any(e is primary for primary in primaries[claim["id"]])
            is_earlier = any(e is other for other in earlier)
            if e["endpoint"] != ("primary" if is_primary else "earlier" if is_earlier else "secondary"):
                differs(f"{claim['id']} {e['where']}: {e['endpoint']} is not its role")
    holm([e for of_claim in primaries.values() for e in of_claim])
    for claim in STATED["claim"]:
        of_claim = [e for e in endpoints if e["claim"] == claim["id"]]
        holm([e for e in of_claim if not any(e is primary for primary in primaries[claim["id"]])])
        for e in of_claim:
            if e["outcome"] != outcome(e):
                differs(f"{claim['id']} {e['where']}: {outcome(e)}, not {e['outcome']}")
            if e["direction"] != direction(e):
                differs(f"{claim['id']} {e['where']}: {direction(e)}, not {e['direction']}")
        outcomes = [outcome(e) for e in primaries[claim["id"]]] + ["undecided"] * missing[claim["id"]]
        if verdict(claim["verdict"], outcomes) != told[claim["id"]]:
            differs(f"{claim['id']}: {verdict(claim['verdict'], outcomes)}, not {told[claim['id']]}")
    claims = {e["claim"] for e in endpoints}
    recompute_figures.check(folder, results, verdict_lines(list(told), endpoints, primaries), differs)
    print(f"{len(endpoints)} ratios of {len(claims)} claims recomputed, {differences} differences")
    return 1 if differences else 0


def main(report, archive=None):
    if not archive:
        return recompute(report, Results(report))
    with tempfile.TemporaryDirectory() as folder, tarfile.open(archive) as packed:
        packed.extractall(folder)
        return recompute(report, Results(pathlib.Path(folder) / "reproduction"))


import recompute_figures  # noqa: E402: it imports this file's functions

if __name__ == "__main__":
    sys.exit(main(*map(pathlib.Path, sys.argv[1:])))
