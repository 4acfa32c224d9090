"""Tables that are written twice: rounded for reading (Markdown), and in full with their parameters (CSV)."""

import csv
import math
from dataclasses import dataclass, field


@dataclass
class Value:
    """A cell: an error, and with which parameters it was reached where they were chosen."""

    error: float
    relative: float = math.nan
    parameter: str = ""
    seconds: float = math.nan


@dataclass
class Table:
    title: str
    columns: list
    rows: dict = field(default_factory=dict)  # name: {column: Value}
    text: str = ""  # under the title
    cell: object = None  # Value -> what the Markdown shows

    def put(self, row, column, value):
        self.rows.setdefault(row, {})[column] = value

    def markdown(self):
        show = self.cell or (lambda value: number(value.error))
        lines = [f"## {self.title}", ""] + ([self.text, ""] if self.text else [])
        lines += ["| | " + " | ".join(self.columns) + " |", "|---" * (len(self.columns) + 1) + "|"]
        for name, values in self.rows.items():
            cells = [show(values[column]) if column in values else "" for column in self.columns]
            lines.append(f"| {name} | " + " | ".join(cells) + " |")
        return "\n".join([*lines, ""])

    def records(self):
        for name, values in self.rows.items():
            for column, value in values.items():
                yield [self.title, name, column, value.parameter, value.error, value.relative, value.seconds]


@dataclass
class Check:
    """A promise, and what was measured of it in this run."""

    promise: str
    measured: str
    holds: bool

    def markdown(self):
        return f"| {self.promise} | {self.measured} | {'yes' if self.holds else '**no**'} |"


def number(value):
    """Four decimals or three digits, whichever tells more."""
    if not math.isfinite(value):
        return "undefined"
    if value < 1e-9:
        return "0.0000"
    return f"{value:.4f}" if value >= 0.01 else f"{value:.2g}"


def write_csv(path, tables):
    with path.open("w", newline="") as file:
        out = csv.writer(file)
        out.writerow("table row column parameter error relative seconds".split())
        for table in tables:
            for record in table.records():
                out.writerow([f"{x:.9g}" if isinstance(x, float) else x for x in record])
