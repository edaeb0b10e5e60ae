"""A campaign folder: ``missions/``, ``platforms/`` and ``reports/`` beside each other.

A mission's campaign is the folder that holds the nearest ``missions/`` above the mission file,
or the file's own folder where there is none. Paths in a mission are relative to the file they
stand in and must stay inside the campaign.
"""

from __future__ import annotations

import difflib
from pathlib import Path

NEAR_FILES, NEAR = 3, 0.7

FOLDERS = ("missions", "platforms", "reports")


def builtin_root() -> Path:
    """The folder that holds the built-in ``missions/`` and ``platforms/``.

    An installed package carries them inside itself; in a checkout they stand at the top level.
    """
    package = Path(__file__).resolve().parent.parent
    carried = package / "builtin"
    return carried if carried.is_dir() else package.parent


def campaign_root(mission: Path) -> Path:
    """The campaign folder of a mission file, symlinks resolved."""
    folder = mission.resolve().parent
    for above in (folder, *folder.parents):
        if above.name == "missions":
            return above.parent
    return folder


def platform_files(root: Path) -> dict[str, Path]:
    """The platforms that a mission of this campaign may name; its own come before built-in ones."""
    return {
        file.stem: file
        for place in (builtin_root(), root)
        for file in sorted((place / "platforms").glob("*.yaml"))
    }


def inside(root: Path, folder: Path, relative: str) -> Path | None:
    """``relative`` to ``folder`` with symlinks resolved, None if it leads out of the campaign."""
    try:
        target = (folder / relative).resolve()
    except (OSError, ValueError, RuntimeError):  # a zero byte, a loop of symlinks
        return None
    return target if target.is_relative_to(root.resolve()) else None


def advice_for_absent(path: Path) -> str:
    """What to say of a file that is not there: those of its folder with nearly its name."""
    folder = path.parent
    if not folder.is_dir():
        return f"there is no folder {folder}"
    alike = {f.stem: f for f in sorted(folder.glob(f"*{path.suffix}")) if is_file(f)}
    near = difflib.get_close_matches(path.stem, alike, n=NEAR_FILES, cutoff=NEAR)
    if not near:
        return f"nothing in {folder} has a name like it"
    return f"did you mean {' or '.join(str(alike[stem]) for stem in near)}?"


def is_file(path: Path) -> bool:
    """Whether there is a readable regular file; a name that is too long is none."""
    try:
        return path.is_file()
    except OSError:
        return False
