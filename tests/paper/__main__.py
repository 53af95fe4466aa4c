"""``PYTHONPATH=tests python -m paper`` writes the tables of docs/paper.md and its figures anew."""

from __future__ import annotations

from pathlib import Path

from paper.claim import as_page
from paper.claims import all_claims
from paper.figures import FIGURES
from paper.panels import draw

ROOT = Path(__file__).resolve().parent.parent.parent
PAGE = ROOT / "docs" / "paper.md"
TABLES = "## The contact patch"  # where the tables of the page begin


def page(text: str, tables: str) -> str:
    """The page with these tables."""
    return text.partition(TABLES)[0].rstrip() + "\n\n" + tables


if __name__ == "__main__":
    PAGE.write_text(page(PAGE.read_text("utf-8"), as_page(all_claims())), "utf-8")
    for number, figure in FIGURES.items():
        draw(figure()).savefig(ROOT / ".pictures" / f"paper-{number:02}.png", dpi=80)
