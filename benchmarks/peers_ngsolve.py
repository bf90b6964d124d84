r"""A problem of `peers.py` by NGSolve: python benchmarks/peers_ngsolve.py ORDER PROBLEM.

NGSolve has no shell element; it has the spaces and the symbolic energies to write one. This is Koiter's shell by the
nonlinear Hellan–Herrmann–Johnson method (Neunteufel and Schöberl, Comput. Struct. 225, 2019), in the parameters of the
patch, so that the undeformed shell X(ξ) is exact. With x = X + u, the bases A_α = X,α and a_α = x,α, the unit normals
N and n, strain E_αβ = (a_α·a_β - A_α·A_β)/2 and change of curvature K_αβ = x,αβ·n - X,αβ·N, the displacement u (H1)
has jumps of its normals on the edges, which the moments m^αβ, whose normal component is continuous, measure:

    Σ_T ∫_T n:E + m:K - ½ n:C⁻¹n - ½ m:D⁻¹m  -  ∫_∂T m_νν l (θ - α)  -  load · u   stationary.

Naghdi's shell, for the limit of fine meshes, has a director that leaves the normal by the shear γ (H(curl)): K less the
symmetric derivative of γ, θ less its component across the edge, and the energy ½ h G γ·γ.

n, m: membrane forces and moments times √A; α: rotation of the edge from its reference normal, which makes m
continuous, so that n and m are eliminated element by element; θ: angle of the element's normal from that reference,
which is perpendicular to the edge and, for the branch of the angle only, taken from the last load step; l: length
across the edge per parameter.
"""

from __future__ import annotations

import shutil
import sys
import time

import ngsolve as ng
import numpy as np
from ngsolve.meshes import MakeStructured2DMesh
from peers_problems import MOST_ITERATIONS, PROBLEMS, TOLERANCE, Answer, fewest_steps

Vector = ng.CoefficientFunction
BONUS = 1
COMPILER = bool(shutil.which("ngscxx") and shutil.which("c++"))


def compiled(integrand: Vector) -> Vector:
    """By the C++ compiler, where NGSolve finds one."""
    return integrand.Compile(realcompile=COMPILER, wait=True)


def unit(v: Vector) -> Vector:
    """v over its length."""
    return v / v.Norm()


def across(v: Vector, t: Vector) -> Vector:
    """Part of v across the unit vector t."""
    return v - (v * t) * t


class Surface:
    """Of coefficient functions: tangents, normal and second derivatives of a position over (ξ, η)."""

    def __init__(self, first: list[Vector], second: list[Vector]) -> None:
        self.a, self.second = first, second
        cross = ng.Cross(*first)
        self.area = ng.sqrt(cross * cross)
        self.n = cross / self.area
        self.dual = [ng.Cross(first[1], self.n) / self.area, ng.Cross(self.n, first[0]) / self.area]

    def metric(self) -> Vector:
        """a_α · a_β."""
        a = self.a
        return Vector((a[0] * a[0], a[0] * a[1], a[0] * a[1], a[1] * a[1]), dims=(2, 2))

    def curvature(self) -> Vector:
        """x,αβ · n."""
        s = self.second
        return Vector((s[0] * self.n, s[1] * self.n, s[1] * self.n, s[2] * self.n), dims=(2, 2))

    def along(self, direction: Vector) -> Vector:
        """Derivative of the position in a direction of the parameters."""
        return direction[0] * self.a[0] + direction[1] * self.a[1]


def undeformed(name: str) -> Surface:
    """X(ξ, η), as in `peers_problems`."""
    if name == "hemisphere":
        polar, azimuth = np.pi / 180 * (18 + 72 * ng.x), np.pi / 2 * ng.y
        X = (10 * ng.sin(polar) * ng.cos(azimuth), 10 * ng.sin(polar) * ng.sin(azimuth), 10 * ng.cos(polar))
    else:
        radius, angle = 6 + 4 * ng.x, 2 * np.pi * ng.y
        X = (radius * ng.cos(angle), radius * ng.sin(angle), 0 * ng.x)
    first = [Vector(tuple(c.Diff(p) for c in X)) for p in (ng.x, ng.y)]
    second = [Vector(tuple(c.Diff(p).Diff(q) for c in X)) for p, q in ((ng.x, ng.x), (ng.x, ng.y), (ng.y, ng.y))]
    return Surface(first, second)


class Shell:
    """The equations of a problem: Koiter's shell, or with `shear` Naghdi's.

    `divisions` are those of s, from 0 to 1, and the number of those of t; by default the problem's.
    """

    def __init__(
        self, name: str, order: int, divisions: tuple[np.ndarray, int] | None = None, shear: bool = False
    ) -> None:
        self.name, self.problem, self.shear = name, PROBLEMS[name], shear
        s, n_t = divisions or (np.linspace(0, 1, self.problem.elements[0] + 1), self.problem.elements[1])
        n_s = len(s) - 1
        self.mesh = MakeStructured2DMesh(
            quads=True, nx=n_s, ny=n_t, mapping=lambda x, y: (float(np.interp(x * n_s, np.arange(n_s + 1), s)), y)
        )
        held, angle = self._held()
        fields = [ng.H1(self.mesh, order=order, dirichlet=held[c]) for c in range(3)]
        spaces = [
            *fields,
            ng.HDivDiv(self.mesh, order=order - 1, discontinuous=True),
            ng.HCurlCurl(self.mesh, order=order - 1, discontinuous=True),
            ng.NormalFacetFESpace(self.mesh, order=order - 1, dirichlet=angle),
        ]
        if shear:
            spaces.append(ng.HCurl(self.mesh, order=order - 1, dirichlet="bottom" if name == "annulus" else ""))
        self.space = ng.FESpace(spaces)
        if name == "hemisphere":
            self._pin()
        self.state = ng.GridFunction(self.space)
        self.X = undeformed(name)
        self.reference = ng.GridFunction(ng.FESpace(fields))
        self.held_normals = None
        self.reset()
        self.held_normals = self.reference.vec.Copy()
        self.load_factor = ng.Parameter(0.0)
        self.form = self._form()

    def reset(self) -> None:
        """No deformation."""
        self.state.vec[:] = 0.0
        self._refer(self.X)

    def _held(self) -> tuple[list[str], str]:
        """Edges on which each component of u, and the edge's rotation, are held."""
        if self.name == "annulus":
            return ["bottom"] * 3, "bottom"
        return ["top", "bottom", ""], "top|bottom"

    def _corner(self, s: int, t: int) -> ng.NodeId:
        for vertex in self.mesh.vertices:
            if np.allclose(vertex.point, (s, t)):
                return vertex
        raise AssertionError

    def _pin(self) -> None:
        """The pulled point stays on the equator's plane."""
        third = self.space.components[2]
        dof = third.GetDofNrs(self._corner(1, 0))[0]
        self.space.FreeDofs().Clear(self.space.Range(2).start + dof)
        self.space.FreeDofs(True).Clear(self.space.Range(2).start + dof)

    def _derivatives(self, u: list[Vector]) -> tuple[list[Vector], list[Vector]]:
        """u,α and u,αβ."""
        first = [Vector(tuple(ng.grad(f)[c] for f in u)) for c in range(2)]
        return first, [Vector(tuple(f.Operator("hesse")[k] for f in u)) for k in (0, 1, 3)]

    def _surface(self, u: list[Vector]) -> Surface:
        first, second = self._derivatives(u)
        return Surface([self.X.a[c] + first[c] for c in range(2)], [self.X.second[c] + second[c] for c in range(3)])

    def _form(self) -> ng.BilinearForm:
        """First variation; NGSolve differentiates it once more."""
        trial, test = self.space.TrialFunction(), self.space.TestFunction()
        u, (m, n, alpha) = trial[:3], trial[3:6]
        v, (dm, dn, dalpha) = test[:3], test[3:6]
        X, x, problem = self.X, self._surface(u), self.problem
        metric = X.metric()
        stretch = problem.youngs_modulus * problem.thickness
        bending = stretch * problem.thickness**2 / 12

        def compliance(forces: Vector) -> Vector:
            """C⁻¹ of the forces, for the unit stretching stiffness."""
            nu, mixed = problem.poissons_ratio, metric * forces
            return ((1 + nu) * mixed * metric - nu * ng.Trace(mixed) * metric) / X.area

        dx, ddx = self._derivatives(v)
        stretching = ng.InnerProduct(n, Vector(tuple(x.a[c] * dx[d] for c in (0, 1) for d in (0, 1)), dims=(2, 2)))
        turned = [
            (ddx[k] - (x.second[k] * x.dual[0]) * dx[0] - (x.second[k] * x.dual[1]) * dx[1]) * x.n for k in range(3)
        ]
        stretching += ng.InnerProduct(dn, 0.5 * (x.metric() - metric))
        turning = ng.InnerProduct(m, Vector((turned[0], turned[1], turned[1], turned[2]), dims=(2, 2)))
        turning += ng.InnerProduct(dm, x.curvature() - X.curvature())
        complementary = ng.InnerProduct(dn, compliance(n)) / stretch + ng.InnerProduct(dm, compliance(m)) / bending

        normal, tangent = ng.specialcf.normal(2), ng.specialcf.tangential(2)
        length = x.along(tangent).Norm()
        t = x.along(tangent) / length
        outward = unit(across(x.along(normal), t))
        last = Vector(tuple(self.reference.components))
        wanted = across(last, t)
        reference = unit(wanted)
        theta = ng.atan2(reference * outward, reference * x.n)
        beside = (reference * x.n) * outward - (reference * outward) * x.n
        dtheta = sum((x.n * dx[c]) * (x.dual[c] * outward) for c in (0, 1))
        dt = tangent[0] * dx[0] + tangent[1] * dx[1]
        dtheta -= (last * t) / (wanted.Norm() * length) * (dt * beside)
        height = across(X.along(normal), unit(X.along(tangent))).Norm()
        edges = (dm * normal * normal) * (theta - alpha * normal) + (m * normal * normal) * (dtheta - dalpha * normal)

        form = ng.BilinearForm(self.space, symmetric=True, condense=True)
        form += compiled(stretching) * ng.dx(bonus_intorder=BONUS)
        form += compiled(turning) * ng.dx(bonus_intorder=BONUS)
        form += compiled(-complementary) * ng.dx(bonus_intorder=BONUS)
        form += compiled(-height * edges) * ng.dx(element_boundary=True, bonus_intorder=BONUS)
        if self.name == "annulus":
            form += -self.load_factor * 4.0 * problem.load * v[2] * ng.ds("top")
        if self.shear:
            gamma, dgamma = trial[6], test[6]
            bending = ng.InnerProduct(m, self._symmetric(dgamma)) + ng.InnerProduct(dm, self._symmetric(gamma))
            form += compiled(-bending) * ng.dx(bonus_intorder=BONUS)
            edges = (m * normal * normal) * (dgamma * normal) + (dm * normal * normal) * (gamma * normal)
            form += compiled(edges) * ng.dx(element_boundary=True, bonus_intorder=BONUS)
            modulus = stretch / (2 * (1 + problem.poissons_ratio))
            shearing = (gamma[0] * X.dual[0] + gamma[1] * X.dual[1]) * (dgamma[0] * X.dual[0] + dgamma[1] * X.dual[1])
            form += compiled(modulus * X.area * shearing) * ng.dx(bonus_intorder=BONUS)
        return form

    def _symmetric(self, gamma: Vector) -> Vector:
        """Symmetric covariant derivative on the undeformed surface."""
        g, X = ng.Grad(gamma), self.X
        e = [g[0, 0], 0.5 * (g[0, 1] + g[1, 0]), g[1, 1]]
        e = [e[k] - (X.second[k] * X.dual[0]) * gamma[0] - (X.second[k] * X.dual[1]) * gamma[1] for k in range(3)]
        return Vector((e[0], e[1], e[1], e[2]), dims=(2, 2))

    def step(self, load_factor: float, tolerance: float = TOLERANCE) -> int:
        """Newton's method at a load; the number of iterations, or 0 where it fails."""
        self.load_factor.Set(load_factor)
        form, state = self.form, self.state
        residual, increment = state.vec.CreateVector(), state.vec.CreateVector()
        dead = self._point_forces(load_factor)
        free = self.space.FreeDofs(True)
        for iteration in range(1, MOST_ITERATIONS + 1):
            form.Apply(state.vec, residual)
            form.AssembleLinearization(state.vec)
            residual.data -= dead
            residual.data += form.harmonic_extension_trans * residual
            inverse = form.mat.Inverse(free, inverse="sparsecholesky")
            increment.data = inverse * residual
            increment.data += form.inner_solve * residual
            increment.data += form.harmonic_extension * increment
            state.vec.data -= increment
            size = [max(np.abs(v.Range(0, self.space.Range(2).stop).FV().NumPy())) for v in (increment, state.vec)]
            if not np.isfinite(size[0]) or size[1] > 1e3:
                return 0
            if size[0] <= tolerance * size[1]:
                self._refer(self._surface(state.components[:3]))
                return iteration
        return 0

    def _point_forces(self, load_factor: float):
        dead = self.state.vec.CreateVector()
        dead[:] = 0.0
        if self.name == "hemisphere":
            for component, t, sign in ((0, 0, 1.0), (1, 1, -1.0)):
                dof = self.space.components[component].GetDofNrs(self._corner(1, t))[0]
                dead[self.space.Range(component).start + dof] = sign * load_factor * self.problem.load
        return dead

    def _refer(self, surface: Surface) -> None:
        """Reference normals of a surface, those of held edges as they were; α, which is measured from them, anew."""
        for component, field in enumerate(self.reference.components):
            field.Set(surface.n[component])
        self.state.components[5].vec[:] = 0.0
        if self.held_normals is not None:
            held = ~self.reference.space.FreeDofs()
            self.reference.vec.data += ng.Projector(held, True) * (self.held_normals - self.reference.vec)

    def values(self) -> dict[str, float]:
        """The displacements that the table has."""
        at = {"w_A": (0, 1, 2, 1), "w_B": (1, 1, 2, 1)}
        if self.name == "hemisphere":
            at = {"inwards": (1, 1, 1, -1), "outwards": (1, 0, 0, 1)}
        return {k: sign * self.state.components[c](self.mesh(s, t)) for k, (s, t, c, sign) in at.items()}


def attempt(shell: Shell, order: int, steps: int) -> Answer:
    """With equal load steps."""
    unknowns = sum(shell.space.FreeDofs(True))
    answer = Answer(f"NGSolve {ng.__version__}", f"HHJ order {order}", shell.name, unknowns, steps)
    shell.reset()
    start = time.process_time()
    for step in range(1, steps + 1):
        solves = shell.step(step / steps)
        answer.solves += solves
        if not solves:
            answer.reason = f"no convergence in {MOST_ITERATIONS} iterations of step {step} of {steps}"
            return answer
    answer.seconds = time.process_time() - start
    answer.values = shell.values()
    return answer


def main() -> None:
    """Command line."""
    order, name = int(sys.argv[1]), sys.argv[2]
    shell = Shell(name, order)
    fewest_steps(lambda steps: attempt(shell, order, steps)).print()


if __name__ == "__main__":
    main()
