"""The table of results."""

from dataclasses import dataclass

HEADINGS = ("check", "measured", "bound", "noise", "verdict")


@dataclass
class Row:
    """One line; all four texts are ready to print."""

    check: str
    measured: str
    bound: str
    noise: str
    verdict: str


class Report:
    """Collects rows; each is also printed as soon as it is known."""

    def __init__(self):
        self.rows = []

    def deviation(self, check, measured, bound, noise):
        """A relative deviation that must lie within ±bound. Noise above half the bound proves nothing, so it fails too."""
        good = abs(measured) <= bound and noise <= bound / 2
        self.add(check, f"{measured:+.2%}", f"±{bound:.1%}", f"{noise:.2%}", good)

    def share(self, check, measured, bound, noise):
        """A share that must reach the bound."""
        self.add(check, f"{measured:.1%}", f"≥ {bound:.0%}", noise, measured >= bound)

    def note(self, check, measured, noise):
        """A figure without a bound."""
        self.append(Row(check, measured, "", noise, "reported"))

    def add(self, check, measured, bound, noise, good):
        """A figure with a verdict."""
        self.append(Row(check, measured, bound, noise, "PASS" if good else "FAIL"))

    def append(self, row):
        """Keeps and prints a row."""
        self.rows.append(row)
        print(f"  {row.check}: {row.measured} ({row.verdict})", flush=True)

    def failed(self):
        """Whether any row failed; no row at all is a failure too."""
        return not self.rows or any(row.verdict == "FAIL" for row in self.rows)

    def print_table(self):
        """All rows, aligned."""
        lines = [HEADINGS] + [(r.check, r.measured, r.bound, r.noise, r.verdict) for r in self.rows]
        widths = [max(len(line[column]) for line in lines) for column in range(len(HEADINGS))]
        print()
        for line in lines:
            print("  ".join(text.ljust(width) for text, width in zip(line, widths)).rstrip())
        print()
