# SPDX-License-Identifier: GPL-3.0-or-later
"""Plain values as YAML that a person reads: maps as blocks down to a level, and what lies deeper in one line."""
import json
import math
import re

import numpy

PLAIN = re.compile(r"[A-Za-z][A-Za-z0-9_./-]*")
WORDS = {"true", "false", "null", "yes", "no", "on", "off", "y", "n"}


class Word(str):
    """A word of the scene format, such as true or linear: it stands without quotes."""


def scalar(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, Word):
        return str(value)
    if isinstance(value, str):
        return value if PLAIN.fullmatch(value) and value.lower() not in WORDS else json.dumps(value, ensure_ascii=False)
    value = float(value)
    if not math.isfinite(value):
        raise ValueError(f"{value} is no number for a scene")
    # The numbers of Blender's fields are floats: their shortest text leaves out what the conversion to double added.
    value += 0.0  # a zero has no sign
    single = numpy.float32(value)
    text = str(single) if float(single) == value else f"{value:.12g}"
    if "e" in text and "." not in text:
        text = text.replace("e", ".0e")  # YAML 1.1 wants the point
    return text


def flow(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k}: {flow(v)}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple)) or hasattr(value, "tolist"):
        return "[" + ", ".join(flow(v) for v in value) + "]"
    return scalar(value)


def dump(tree, depth=2, indent=0):
    """The text of a map; maps `depth` levels down are blocks if they hold maps or do not fit into a line."""
    lines = []
    for key, value in tree.items():
        line = f"{' ' * indent}{key}: {flow(value)}"
        if isinstance(value, dict) and value and depth > 0 and (
                len(line) > 100 or any(isinstance(v, dict) for v in value.values())):
            lines.append(f"{' ' * indent}{key}:")
            lines.append(dump(value, depth - 1, indent + 2).rstrip("\n"))
        elif isinstance(value, list) and len(line) > 120 and any(isinstance(v, dict) for v in value):
            lines.append(f"{' ' * indent}{key}:")
            lines += [f"{' ' * (indent + 2)}- {flow(v)}" for v in value]
        else:
            lines.append(line)
    return "\n".join(lines) + "\n"
