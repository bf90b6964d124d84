"""Which fronts are eliminated together, by one thread: subtrees, then what is above them.

The division depends on the pattern alone, and every front adds the updates of its children in the same order, so
results are the same to the last bit whatever the number of threads.
"""

from __future__ import annotations

import heapq
from typing import NamedTuple

import numpy as np

from magshell.arrays import IntArray
from magshell.linalg.multifrontal.fronts import Fronts

# Operations below which a factorisation is one task; the largest share of them that a task of several may have.
SMALL, LARGEST_SHARE = 1e9, 1 / 12


class Schedule(NamedTuple):
    """Tasks and memory.

    Attributes
    ----------
    tasks : list of ndarray
        Fronts of each subtree, in order; the largest task first.
    top : ndarray
        The other fronts, in order.
    child_pointer, child : ndarray
        Children of each front.
    update_at : ndarray, shape (fronts,)
        Where the update of a front lies: on the stack of its task, or, if negative, the complement of its place among
        the updates that are kept from the tasks for the top.
    kept, stack, largest, widest : int
        Entries of the kept updates, of the largest stack, of the largest update and of the largest upper panel.
    """

    tasks: list[IntArray]
    top: IntArray
    child_pointer: IntArray
    child: IntArray
    update_at: IntArray
    kept: int
    stack: int
    largest: int
    widest: int


def schedule_of(fronts: Fronts) -> Schedule:
    """Divide the fronts."""
    count = fronts.parent.size
    parent, size = fronts.parent.tolist(), (fronts.beyond**2).tolist()
    children: list[list[int]] = [[] for _ in range(count)]
    operations, first = fronts.operations.tolist(), list(range(count))
    for s, p in enumerate(parent):
        if p >= 0:
            children[p].append(s)
            operations[p] += operations[s]
            first[p] = min(first[p], first[s])
    roots = _task_roots(operations, children, [s for s, p in enumerate(parent) if p < 0])
    update_at = np.zeros(count, dtype=np.int64)
    kept, stack, in_task = 0, 0, np.zeros(count, dtype=bool)
    tasks = []
    for root in sorted(roots, key=lambda root: -operations[root]):
        tasks.append(np.arange(first[root], root + 1))
        in_task[tasks[-1]] = True
        stack = max(stack, _stack_up(tasks[-1].tolist(), children, size, update_at, set()))
        update_at[root] = ~kept
        kept += size[root]
    top = np.flatnonzero(~in_task)
    stack = max(stack, _stack_up(top.tolist(), children, size, update_at, set(roots)))
    pointer = np.append(0, np.cumsum([len(own) for own in children]))
    child = np.array([c for own in children for c in own], dtype=np.int64)
    widest = int((fronts.beyond * fronts.pivots).max(initial=0))
    return Schedule(tasks, top, pointer, child, update_at, kept, stack, max(size, default=0), widest)


def _task_roots(operations: list[float], children: list[list[int]], roots: list[int]) -> list[int]:
    """Roots of subtrees of at most the largest share of all operations; none where there is little to do."""
    total = sum(operations[root] for root in roots)
    if total < SMALL:
        return []
    waiting = [(-operations[root], root) for root in roots]
    heapq.heapify(waiting)
    while waiting and -waiting[0][0] > LARGEST_SHARE * total:
        _, largest = heapq.heappop(waiting)
        for child in children[largest]:
            heapq.heappush(waiting, (-operations[child], child))
    return [root for work, root in waiting if -work > 1e-3 * total]


def _stack_up(
    sequence: list[int], children: list[list[int]], size: list[int], update_at: IntArray, elsewhere: set[int]
) -> int:
    """Place the updates of a sequence of fronts on a stack; its largest height."""
    height, largest = 0, 0
    for s in sequence:
        height -= sum(size[c] for c in children[s] if c not in elsewhere)
        update_at[s] = height
        height += size[s]
        largest = max(largest, height)
    return largest
