"""``inspect study``: its options are those of the registered studies.

Each factor of a study states its option (``commands.sweeps.Factor``), so that a new study edits
nothing here. The studies import much; their options are added when the command itself is parsed
or its help is shown, and ``inspect --help`` stays quick.
"""

from __future__ import annotations

import sys
from inspect import Parameter, Signature
from typing import TYPE_CHECKING, Annotated, Any, cast

import typer
from typer.core import TyperCommand
from typer.main import get_command

from inspect_cli.cli.program import Json, Language, Mission, Out, stdout_kept_clean

if TYPE_CHECKING:
    from collections.abc import Mapping

    from inspect_cli.commands.sweeps import Study

ASKED = "inspect_cli.study.asked"
"""Where the context keeps the texts of the studies' options, by option."""


class StudyCommand(TyperCommand):
    """The command with the options of every study."""

    _completed = False

    def get_params(self, ctx: Any) -> Any:
        """The parameters of ``study``, with an option for each factor ahead of ``--fly``."""
        if not self._completed:
            self._completed = True
            self._complete()
        return super().get_params(ctx)

    def _complete(self) -> None:
        from inspect_cli.commands.study import STUDIES

        names = [param.name for param in self.params]
        sampling = ", ".join(name for name, study in STUDIES.items() if study.sampler)
        of_name, of_fly = (cast(Any, self.params[names.index(one)]) for one in ("name", "fly"))
        of_name.help = f"Which study: {', '.join(STUDIES)}."
        of_fly.help = f"{sampling}: fly each variant once, beside the samples."
        index = names.index("fly")
        self.params[index:index] = _options(STUDIES)


def study(
    context: typer.Context,
    name: Annotated[str, typer.Argument(metavar="NAME", help="Which study.")],
    mission: Mission,
    fly: Annotated[
        bool, typer.Option("--fly", help="Fly each variant once, beside the samples.")
    ] = False,
    out: Out = None,
    seed: Annotated[
        int | None, typer.Option(min=0, help="Of the noise; by default the mission's first.")
    ] = None,
    jobs: Annotated[int, typer.Option(min=1, help="Flights at a time.")] = 1,
    language: Language = "en",
    as_json: Json = False,
) -> int:
    """Fly or sample a mission with varied numbers; show what they do to its metrics."""
    from inspect_cli import terminal
    from inspect_cli.commands.study import study as command

    with stdout_kept_clean():
        terminal.announce_compilation(shown=not as_json)
        with terminal.regression_progress(shown=not as_json) as progress:
            outcome = command(
                name,
                mission,
                asked=context.meta.get(ASKED, {}),
                out=out,
                seed=seed,
                jobs=jobs,
                language=language,
                fly_sampled=fly,
                progress=progress,
            )
    if as_json:
        sys.stdout.write(outcome.result.model_dump_json(by_alias=True) + "\n")
    else:
        terminal.print_study(outcome.result, outcome.page)
    return outcome.exit_code


def _options(studies: Mapping[str, Study]) -> list[Any]:
    """One option per factor; studies that vary the same option share it."""
    metavars: dict[str, str] = {}
    helps: dict[str, list[str]] = {}
    for name, study in studies.items():
        for factor in study.factors:
            metavars.setdefault(factor.option, factor.metavar)
            helps.setdefault(factor.option, []).append(f"{name}: {factor.help}")
    parameters = [
        _parameter(option, metavars[option], f"{'; '.join(texts)}.")
        for option, texts in helps.items()
    ]

    def options() -> None:
        """Carries the options' declarations, from which Typer makes them."""

    cast(Any, options).__signature__ = Signature(parameters)
    options.__annotations__ = {one.name: one.annotation for one in parameters}
    app = typer.Typer(add_completion=False)
    app.command()(options)
    return get_command(app).params


def _parameter(option: str, metavar: str, text: str) -> Parameter:
    def remember(context: typer.Context, value: str | None) -> None:
        if value is not None:
            context.meta.setdefault(ASKED, {})[option] = value

    declared = typer.Option(
        f"--{option}", metavar=metavar, help=text, callback=remember, expose_value=False
    )
    annotation = Annotated[str | None, declared]
    name = option.replace("-", "_")
    return Parameter(name, Parameter.KEYWORD_ONLY, default=None, annotation=annotation)
