"""Published problems of shells: solve, draw, and write the tables of `published-shells.md`.

    python docs/make_published_study.py      some minutes of CPU time

Every finished run is kept in results/published-study/runs.json, so the study may be interrupted and goes on where it
was. Runs of other sources are not reused.
"""

from __future__ import annotations

from published_study.page import Study, write
from published_study.pictures import IMAGES, draw_curves, draw_errors
from published_study.problems import PROBLEMS
from published_study.questions import hinge_sentence, law_sentence
from published_study.runs import Runs


def main() -> None:
    """Run what is missing, then draw and write."""
    IMAGES.mkdir(exist_ok=True)
    runs = Runs()
    studies = [
        Study(published, {
            variant: {divisions: runs.of(published, variant, divisions) for divisions in meshes}
            for variant, meshes in published.meshes.items()
        })
        for published in PROBLEMS
    ]  # fmt: skip
    draw_curves([(study.published, study.finest) for study in studies], "published-curves")
    draw_errors(
        [(one.published, {variant: one.errors(variant) for variant in one.found}) for one in studies],
        "published-errors",
    )
    write(studies, {"law": law_sentence(runs), "hinge": hinge_sentence(runs)})
    print(f"CPU time of all runs: {runs.cpu:.0f} s")


if __name__ == "__main__":
    main()
