"""Compare the element types `quadratic` and `paper`: write the tables and pictures of `element.md`.

    python docs/make_element_study.py                    about twenty minutes of CPU time
    python docs/make_element_study.py --only triangles   the table of triangles, two minutes
    python docs/make_element_study.py --only bent-triangles   that of a strip that bends far, half a minute

Every finished run is kept in results/element-study/runs.json, so the study may be interrupted and goes on where it
was. Runs of other sources are not reused. CPU times are those of one process and one thread.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from typing import Any

from element_study.candidates import CANDIDATES, clamped_plate, displacements, modes, soft_mode, thin_strip, tip
from element_study.cases import MEMBERS, SMALL_LENGTH_SCALE, Case, Divisions, built_in, cases
from element_study.convergence import series
from element_study.pictures import IMAGES, Panel, draw_errors, draw_nodes
from element_study.runs import Run, Store, again, run
from element_study.tables import (
    Pair,
    limit_table,
    mesh_table,
    published_table,
    ratio_table,
    stabilisation_table,
    write,
)
from element_study.triangles import bent_table, triangle_table

import magshell as ms
from magshell.shell.elements import PAPER, QUADRATIC


def main() -> None:
    """Run what is missing, then write tables and pictures."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", choices=["triangles", "bent-triangles"], help="write this table only")
    only = parser.parse_args().only
    store, begin = Store(), time.process_time()
    made = {"triangles": triangle_table, "bent-triangles": bent_table}
    triangles = {name: store.get(name, make) for name, make in made.items() if only in (None, name)}
    if only:
        print(triangles[only])
        write(triangles)
        return
    IMAGES.mkdir(exist_ok=True)
    warm_up()
    every = cases()
    found = {case.name: {member: runs(store, case, member) for member in MEMBERS} for case in every}
    pairs = [
        Pair(case, quantity, *(series(found[case.name][member], case, member, quantity) for member in MEMBERS))
        for case in every
        for quantity in case.quantities
    ]
    of = {name: [pair for pair in pairs if pair.case.name == name] for name in found}
    limits = {
        "gripper 15x4": of["gripper"][0].quadratic.limit,
        "pump 6x5": of["pump"][0].quadratic.limit,
        "pump 12x10": of["pump"][0].quadratic.limit,
        "strip": store.get("thin strip", lambda: tip(thin_strip(QUADRATIC, (32, 4), 0.0), "tip", 3)),
    }
    limits["distorted strip"] = limits["strip"]
    limits["plate"] = store.get("clamped plate", lambda: tip(clamped_plate(QUADRATIC, 16), "centre", 3))
    published = {name: length_scales(store, name, model) for name, model in SMALL_LENGTH_SCALE.items()}
    tables = {
        "ratios": ratio_table(pairs),
        "gripper": mesh_table(of["gripper"], of["gripper"][0].case.meshes),
        "limits": limit_table(pairs),
        "published": published_table(published, [of[name][0] for name in published]),
        "stabilisation": stabilisation_table(candidates(store), limits),
        "soft": soft_sentence(store),
        **triangles,
    }
    print("\n\n".join(tables.values()))
    write(tables)
    draw_nodes()
    pictures = {
        "element-gripper": of["gripper"],
        "element-pump": of["pump"] + of["pump-150"],
        "element-strips": [of[name][1] for name in of if name.startswith("strip")],
        "element-others": [of["thin-cross"][1], *(of[name][0] for name in published)],
    }
    for name, shown in pictures.items():
        draw_errors([Panel(pair.name, [pair.quadratic, pair.paper]) for pair in shown], name)
    print(f"{time.process_time() - begin:.0f} s of CPU time now")


def warm_up() -> None:
    """Compile, or load, the kernels: that time counts for nobody."""
    print("kernels ...", flush=True)
    for member in MEMBERS:
        ms.solve(built_in("gripper", (2, 2), member, [1e-5]))


def runs(store: Store, case: Case, member: str) -> list[dict[str, Any]]:
    """All meshes of a case and member, each told when it is there."""
    every = []
    for divisions in case.meshes[member]:
        name = f"{case.name} {member} {divisions[0]}x{divisions[1]}"
        every.append(one_run(store, name, case, member, divisions))
        entry = every[-1]
        last = f"{entry['cpu'][-1]:8.2f} s" if entry["cpu"] else "not reached"
        print(f"{name:34s} {entry['unknowns']:7d} unknowns {last} {entry['reason']}", flush=True)
    return every


def one_run(store: Store, name: str, case: Case, member: str, divisions: Divisions) -> dict[str, Any]:
    """A run, with the least of several CPU times where it is quick."""

    def model() -> ms.Model:
        return case.model(divisions, member, case.stops)

    released = case.released
    if released is not None:
        return store.get(name, lambda: run(model, case.stops, lambda: released(divisions, member, case.stops)))
    entry = store.get(name, lambda: run(model, case.stops))
    return entry | {"cpu": store.get(f"{name} cpu", lambda: again(model, Run(**entry)))}


def length_scales(store: Store, name: str, small: Any) -> dict[str, float]:
    """A published problem with l = h/100 and h/10, on its second mesh."""
    case = next(case for case in cases() if case.name == name)
    divisions, quantity = case.meshes["quadratic"][1], case.quantities[0]

    def value(entry: dict[str, Any]) -> float:
        return quantity.scale * entry["displacements"][quantity.probe][-1][quantity.component - 1]

    thin = store.get(f"{name} with h/100", lambda: run(lambda: small(divisions, QUADRATIC, ()), [1.0]))
    thick = one_run(store, f"{name} quadratic {divisions[0]}x{divisions[1]}", case, "quadratic", divisions)
    return {"small": value(thin), "large": value(thick)}


def candidates(store: Store) -> dict[str, dict[str, Any]]:
    """Modes, displacements and points of every candidate."""
    found = {}
    for candidate in CANDIDATES:
        print(candidate.title, flush=True)
        found[candidate.title] = {
            "modes": store.get(f"{candidate.title}, modes", lambda candidate=candidate: modes(candidate)),
            "displacements": store.get(candidate.title, lambda candidate=candidate: displacements(candidate)),
            "points": len(candidate.element.rule.weights),
        }
    return found


def soft_sentence(store: Store) -> str:
    """What the softest mode of one square element is."""
    quadratic, paper = (
        store.get(f"soft mode of {element.name}", lambda element=element: soft_mode(element))
        for element in (QUADRATIC, PAPER)
    )
    ours, theirs = quadratic, paper
    alike: Sequence[float] = (ours["alike"], theirs["alike"])
    return (
        f"On a square, thickness a hundredth of the side: eigenvalue {ours['eigenvalue']:.1e} (`quadratic`) and "
        f"{theirs['eigenvalue']:.1e} (`paper`); doubling $l$ multiplies them by {ours['doubled']:.2f} and "
        f"{theirs['doubled']:.2f}; the cosine between $u$ and that mode is 1 less {1.0 - min(alike):.0e} at most."
    )


if __name__ == "__main__":
    main()
