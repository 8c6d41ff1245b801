"""Recomputes the figures of bodies in contact from the tables of their studies, without any code of the program that
drew them.

A point is what STUDY.csv states of it, if it has such a row, or a closed form; else the point of STUDY_points.csv, a
sample of a trajectory. Rows that state the least or the greatest of drawn samples are recomputed from these.
"""

import csv
import math
import re

from recompute_lines import Lines

STEP = re.compile(r"(\w+), (?:(\S+) s|tolerance (\S+))")


# Closed forms.


def restitution(damping, may_pull):
    root = math.sqrt(1 - damping * damping)
    return math.exp(-damping * (math.pi if may_pull else 2 * math.acos(damping)) / root)


def quarter_period(modulus):
    """The complete elliptic integral K, by the arithmetic-geometric mean."""
    a, b = 1.0, math.sqrt(1 - modulus * modulus)
    while abs(a - b) > 1e-15 * a:
        a, b = (a + b) / 2, math.sqrt(a * b)
    return math.pi / (2 * a)


def sine_amplitude(u, modulus):
    """Jacobi's sn by the descending scheme of the arithmetic-geometric mean (Abramowitz and Stegun 16.4)."""
    a, b, c = [1.0], math.sqrt(1 - modulus * modulus), [modulus]
    while abs(c[-1]) > 1e-16:
        mean, difference = (a[-1] + b) / 2, (a[-1] - b) / 2
        b = math.sqrt(a[-1] * b)
        a.append(mean)
        c.append(difference)
    phase = 2 ** (len(a) - 1) * a[-1] * u
    for n in range(len(a) - 1, 0, -1):
        phase = (phase + math.asin(c[n] / a[n] * math.sin(phase))) / 2
    return math.sin(phase)


def flips():
    """The spin about the middle axis of a body with moments 2, 3 and 4, for three flips and a half."""
    least, middle, greatest, third, modulus = 2, 3, 4, 5.0, math.sqrt(0.9)
    # The modulus k² = (b - a) a w1²/((c - b) c w3²).
    first = third * modulus * math.sqrt((greatest - middle) * greatest / ((middle - least) * least))
    amplitude = first * math.sqrt(least * (greatest - least) / (middle * (greatest - middle)))
    rate = third * math.sqrt((greatest - middle) * (greatest - least) / (least * middle))
    end = 3.5 * 2 * quarter_period(modulus) / rate
    return [{"x": end * i / 200, "y": amplitude * sine_amplitude(rate * end * i / 200, modulus)} for i in range(201)]


CLOSED_FORMS = {  # y of x, by figure and line
    ("tunnelled", "1 - extent / displacement"): lambda x: max(0.0, 1 - 1 / x),
    ("restitution_over_damping", "dashpot may pull, closed form"): lambda x: restitution(x, may_pull=True),
    ("restitution_over_damping", "no pull, closed form"): lambda x: restitution(x, may_pull=False),
}

# Lines that are the same in every run: figure, line and points, by study.
FIXED_LINES = {
    "oblique_impact": ("oblique", "closed form", [{"x": x, "y": min(1.0, 2 / 7 * x)} for x in (1, 3.5, 5)]),
    "spinning_disc": ("disc", "0.653", [{"y": 0.653}]),
    "sliding": ("sliding_force", "exact", [{"y": 1}]),
}


# What rows state of points.


def of_facets(subject, quantity):
    for line in ("rolling speed", "depth"):
        if quantity == line + ", error":
            return line, float(subject.split()[0])


def of_impact(subject, quantity):
    found = re.fullmatch(r"(\w+), e 1, slip (\S+) μ\(1\+e\) v_n", subject)
    if found and quantity.startswith("tangential speed lost"):
        return found[1], float(found[2])


def of_plate(subject, _):
    found = re.fullmatch(r"a step of (\S+) extents, (plain|swept)", subject)
    if found:
        return found[2] + " boxes", float(found[1])


def of_scaled_step(*quantities):
    def place(subject, quantity):
        found = re.fullmatch(r"(\w+), dt·ω (\S+)", subject)
        if found and quantity in quantities:
            return found[1], float(found[2])

    return place


def of_bounce(subject, quantity):
    found = re.fullmatch(r"runge_kutta_4, ζ ([\d.]+)(, no pull)?", subject)
    if found and quantity == "restitution":
        return "no pull" if found[2] else "dashpot may pull", float(found[1])


def of_steps(subject, quantity):
    found = STEP.fullmatch(subject)
    if found and quantity == "trajectory error at the end (diameters)":
        return found[1], f"{1e3 * float(found[2]):.4g} ms" if found[2] else f"{float(found[3]):.0e}"


# By figure: the line of a row's point, and its x, or its label where x is a time.
STATED_POINTS = {
    "facets": of_facets,
    "oblique": of_impact,
    "tunnelled": of_plate,
    "energy_gain": of_scaled_step("greatest energy gain of a bounce"),
    "energy_drift": of_scaled_step("energy drift", "change of the conserved energy"),
    "ball_error_over_step": of_scaled_step("trajectory error (relative)"),
    "restitution_over_damping": of_bounce,
    "error_over_time": of_steps,
}

# Figures of absolute values.
ABSOLUTE = ("facets", "energy_drift")

# By figure: rows that state an extreme of all y of a line: that line's pattern of subject, the quantity, the extreme.
STATED_EXTREMES = {
    "transmission_error": ("{}", {"least transmission error (µm)": min, "greatest transmission error (µm)": max}),
    "play": ("{}", {"least play at every phase (µm)": min, "greatest play at every phase (µm)": max}),
    "departure_1_m": ("{}, 1 m", {"greatest deviation (diameters)": max}),
    "departure_10_mm": ("{}, 10 mm", {"greatest deviation (diameters)": max}),
    "depth_1_m": ("{}, 1 m", {"greatest depth of two balls (diameters)": max}),
    "depth_10_mm": ("{}, 10 mm", {"greatest depth of two balls (diameters)": max}),
    "sliding_force": ("{}", {"least force, oblique, 10 mm": min}),
}


def table(file):
    with open(file, newline="", encoding="utf-8") as text:
        return list(csv.DictReader(text))


def stated_in(rows, name):
    """What rows state of a figure's points, by line and x or label."""
    found = {}
    for row in rows if name in STATED_POINTS else []:
        if at := STATED_POINTS[name](row["subject"], row["quantity"]):
            value = float(row["measured"])
            found[at] = abs(value) if name in ABSOLUTE else value
    return found


def check_extremes(name, lines, rows, differs):
    pattern, quantities = STATED_EXTREMES[name]
    for (_, line), points in lines.items():
        for row in rows if "x" in points[0] else []:
            if row["subject"] == pattern.format(line) and row["quantity"] in quantities:
                extreme = quantities[row["quantity"]](point["y"] for point in points)
                if not math.isclose(extreme, float(row["measured"]), rel_tol=1e-6, abs_tol=1e-12):
                    differs(f"{name}: {line}: {row['quantity']} is {extreme:.6g}, not {row['measured']}")


def figures_of(study, rows, points):
    """The figures of a study by name, and how many of their points rows or closed forms give."""
    figures, given = {}, 0
    for point in points:
        lines = figures.setdefault(point["figure"], Lines())
        lines.add(point["line"], [{"x": float(point["x"]), "y": float(point["y"]), "label": point.get("label")}])
    for name, lines in figures.items():
        stated = stated_in(rows, name)
        for (_, line), of_line in lines.items():
            closed = CLOSED_FORMS.get((name, line))
            for point in of_line:
                at = line, point.pop("label") or point["x"]
                if closed or at in stated:
                    point["y"] = closed(point["x"]) if closed else stated[at]
                    given += 1
    if ("", "closed form") in figures.get("flips", {}):
        figures["flips"]["", "closed form"] = flips()
        given += len(flips())
    if study in FIXED_LINES:
        name, line, of_line = FIXED_LINES[study]
        figures.setdefault(name, Lines()).add(line, of_line)
        given += len(of_line)
    return figures, given


def stiff_figures(folder, differs):
    """The figures of all studies by name. Calls `differs` with a sentence per row that its samples do not give."""
    figures, given = {}, 0
    for file in sorted(folder.glob("*_points.csv")):
        study = file.name.removesuffix("_points.csv")
        rows = table(file.with_name(study + ".csv"))
        of_study, of_points = figures_of(study, rows, table(file))
        for name in of_study.keys() & STATED_EXTREMES.keys():
            check_extremes(name, of_study[name], rows, differs)
        figures.update(of_study)
        given += of_points
    if figures:
        count = sum(len(points) for lines in figures.values() for points in lines.values())
        print(f"of {count} points of bodies in contact, rows or closed forms give {given}; others are samples of motions")
    return figures
