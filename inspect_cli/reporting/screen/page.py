"""The HTML page around the content: one file that loads nothing."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence
from importlib import resources

from plotly.offline import get_plotlyjs

from inspect_cli.reporting.figures.palette import css_variables, plot_template
from inspect_cli.reporting.screen.markup import Markup, data_script, element, joined
from inspect_cli.reporting.words.language import Language
from inspect_cli.reporting.words.text import say

PLOT_WORDS = (
    say("Download plot as a PNG"),
    say("Zoom"),
    say("Pan"),
    say("Reset axes"),
    say("Orbital rotation"),
    say("Reset camera to default"),
    say("Double-click to zoom back out"),
    say("Taking snapshot - this may take a few seconds"),
    say("Snapshot succeeded"),
    say("Sorry, there was a problem downloading your snapshot!"),
)
"""Plotly's own words on this page; the English ones are the keys of its dictionaries."""


def page(
    title: str,
    header: Markup,
    anchors: Sequence[tuple[str, Markup]],
    sections: Sequence[Markup],
    language: Language,
) -> str:
    """The whole document; ``anchors`` are the sections' names with their headings.

    Plotly stands in it once. The content security policy forbids every request, and every
    script but the two that are named by their hash: text that would slip through as markup
    still could not run.
    """
    scripts = [get_plotlyjs().replace("\r\n", "\n").replace("\r", "\n"), _file("page.js")]
    links = (element("a", heading, href=f"#{name}") for name, heading in anchors)
    label = language.plain(say("Sections"))
    content = [
        element("header", header),
        element("nav", *links, aria_label=label),
        element("main", *sections),
        data_script(plot_template(), id="plot-template"),
        data_script({w.template: language.plain(w) for w in PLOT_WORDS}, id="plot-words"),
        *(element("script", Markup(script)) for script in scripts),
    ]
    head = joined(
        Markup('<meta charset="utf-8">'),
        Markup(f'<meta http-equiv="Content-Security-Policy" content="{_policy(scripts)}">'),
        Markup('<meta name="viewport" content="width=device-width, initial-scale=1">'),
        Markup('<link rel="icon" href="data:,">'),
        element("title", title),
        element("style", Markup(css_variables() + _file("page.css"))),
    )
    document = element("html", element("head", head), element("body", *content), lang=language.code)
    return f"<!DOCTYPE html>\n{document}\n"


def _file(name: str) -> str:
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


def _policy(scripts: Sequence[str]) -> str:
    hashes = " ".join(f"'sha256-{_sha256(script)}'" for script in scripts)
    return (
        f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; "
        "img-src data: blob:; media-src data:; base-uri 'none'; form-action 'none'"
    )


def _sha256(script: str) -> str:
    return base64.b64encode(hashlib.sha256(script.encode()).digest()).decode("ascii")
