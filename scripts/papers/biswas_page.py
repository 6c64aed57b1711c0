"""The page of Biswas, Shapiro and Tsukanov."""

from papers import biswas_tables as tables
from papers.biswas_figures import PARTS
from papers.page import table
from papers.paper import Paper


def values() -> dict[str, str]:
    """What the page says besides its figures."""
    return {
        "readings": table(("place", "printed", "read as", "because"), tables.READINGS),
        "chosen": table(("section", "not printed", "chosen here"), tables.CHOSEN),
    }


PAPER = Paper("biswas", PARTS, values=values)
