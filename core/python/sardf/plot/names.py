"""Names that a user may mistype."""

import difflib

import sardf

LONGEST_LIST = 40


def fail(message: str):
    """Raises Error with the message, for input that is wrong."""
    raise sardf.Error(message)


def choose(kind: str, name: str, accepted):
    """accepted[name], or `name` itself where `accepted` is a list; Error that names the nearest."""
    if name in accepted:
        return accepted[name] if isinstance(accepted, dict) else name
    if not accepted:
        fail(f"there is no {kind} '{name}': the scene has none")
    near = difflib.get_close_matches(name, list(accepted), n=1, cutoff=0.5)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    listed = f"accepted are {', '.join(accepted)}"
    if len(accepted) > LONGEST_LIST:
        listed = f"{len(accepted)} names are accepted, such as {', '.join(list(accepted)[:5])}"
    return fail(f"there is no {kind} '{name}'; {listed}{hint}")
