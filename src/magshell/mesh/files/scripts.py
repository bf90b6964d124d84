"""gmsh's scripts (`.geo`), of which only statements that draw a geometry are run.

gmsh's language also runs programs, writes files and makes names of commands out of texts. A script is therefore taken
apart into the words of that language, every statement must begin with a word that is known to be harmless or assign to
a variable, and gmsh gets what was understood here, without comments, in a folder of its own.
"""

from __future__ import annotations

import pathlib
import re
import shutil
from dataclasses import dataclass, field
from typing import NamedTuple, NoReturn

from magshell.errors import InputError
from magshell.units import shortened

SCRIPTS = (".geo", ".geo_unrolled")
PARTS = (".step", ".stp", ".iges", ".igs", ".brep")
"""Geometries that a script may merge."""
MOST_FILES = 100
"""That a script and what it includes may be made of."""
LONGEST = 1000
"""Bytes of a word or text: gmsh reads what is behind the 1023rd of a text as commands."""
LONGEST_LINE = 2000
"""Characters: of longer lines gmsh may read again from the middle, in loops."""


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


KEYWORDS = _words(
    """
    Abort Abs Acos AdaptMesh Affine Alias AliasWithOptions Append ArcCos ArcSin ArcTan ArcTan2 Asin Atan Atan2
    BSpline Betti Bezier Block BooleanCoherence BooleanCommon BooleanCut BooleanDifference BooleanFragments
    BooleanFuse BooleanIntersection BooleanSection BooleanUnion BoundingBox Box Call Catenary CatmullRom Ceil
    CenterOfMass Chamfer Characteristic Circle ClassifySurfaces Closest CodeName Coherence Cohomology Color
    ColorTable Combine Compound Cone Coordinates CopyOptions Cos Cosh Cpu CreateGeometry CreateMeshEdges
    CreateMeshFaces CreateTopology Curvature Curve Cylinder DefineConstant DefineNumber DefineString Degenerated
    Delete Dilate DimNameSpace Disk Draw Ellipse Ellipsis Ellipsoid Elliptic Else ElseIf EndFor EndIf Error
    Euclidean Euclidian Exists Exit Exp Extrude Fabs Field Fillet Find Floor Fmod For Function GMSH_MAJOR_VERSION
    GMSH_MINOR_VERSION GMSH_PATCH_VERSION GeoEntity GetForced GetForcedStr GetNumber GetString HealShapes Hide Hole
    Homology Hypot If In Intersect Knots Layers Length Levelset Line LinSpace List Log Log10 LogSpace LowerCase
    LowerCaseIn MPI_Rank MPI_Size Macro Mass MatrixOfInertia Max Memory MeshAlgorithm MeshSize MeshSizeFromBoundary
    Min Modulo N2S NameStruct NameToString NewModel Normal Nurbs Order Parametric Parent Periodic Physical Pi Plane
    Point PolarSphere Printf QuadTriAddVerts QuadTriNoNewVerts Quadric Rand RecombLaterals Recombine RecombineMesh
    Rectangle Recursive RefineMesh RelocateMesh RenumberMeshElements RenumberMeshNodes ReorientMesh Return Reverse
    ReverseMesh Rotate Round Ruled ScaleLastLayer SetChanged SetFactory SetMaxTag SetNumber SetPartition SetString
    SetTag Sewing ShapeFromFile Show Sin Sinh Smoother Sphere Spline Split Sprintf Sqrt Step Str StrCat StrChoice
    StrCmp StrFind StrLen StrPrefix StrRelative StrReplace StrSub Struct Surface Symmetry SyncModel Tan Tanh
    TestLevel ThickSolid ThruSections Today Torus TotalMemory TransfQuadTri Transfinite TransformMesh Translate
    UndefineConstant Unique UnsplitWindow UpperCase Using Volume Warning Wedge Wire newc newcl newf newl newll newp
    newreg news newsl newv
    """
)
"""Words of the language, but for those of `FORBIDDEN`."""
COMMANDS = _words(
    """
    Mesh SetOrder SetName OptimizeMesh Background BoundaryLayer Duplicata Boundary CombinedBoundary PointsOf Right
    Left Alternate AlternateRight AlternateLeft
    """
)
"""What else may begin a statement or end one."""
FORBIDDEN = _words(
    """
    AbsolutePath CommandLine CreateDir CurrentDir CurrentDirectory CurrentFileName DirName ExternalProcess
    FileExists FileName FixRelativePath GetEnv GetStringValue GetValue GmshExecutableName ListFromFile
    NonBlockingSystemCall OnelabAction OnelabRun Plugin Print S2N Save SendToServer Sleep Slide StringToName System
    SystemCall
    """
)
"""Words that are never allowed: they run programs, write, read what is outside the script, or make such words."""
OPTIONS = ("Mesh", "Geometry", "General")
"""Kinds of options that may be set."""
OTHER_OPTIONS = ("PostProcessing", "Print", "Solver", "View")
GENERAL = ("AbortOnError", "ExpertMode", "NumThreads", "Terminal", "Verbosity")
"""Of the options `General.…` these may be set: others write files at the end."""
FIELDS = _words(
    """
    Attractor AttractorAnisoCurve AutomaticMeshSizeField Ball BoundaryLayer Box Constant Curvature Cylinder Distance
    Extend Frustum Gradient Intersect IntersectAniso Laplacian LonLat MathEval MathEvalAniso Max MaxEigenHessian
    Mean Min MinAniso Octree Param PostView Restrict Threshold
    """
)
"""Kinds of fields of sizes that run nothing."""

_TOKEN = re.compile(
    r"(?P<blank>[ \t\n\r\f]+|//[^\n]*|/\*.*?\*/)"
    r"|(?P<text>\"[^\"\n\r\0]*\"|'[^'\n\r\0]*')"
    r"|(?P<number>(?:\d+\.?\d*|\.\d+)(?:[Ee][-+]?\d+)?)"
    r"|(?P<word>[A-Za-z_][A-Za-z_0-9]*)"
    r"|(?P<sign>\.\.\.|::|\|\||&&|\+\+|--|==|!=|<=|>=|>>|<<|\+=|-=|\*=|/=|[-+*/^%=<>!?:,.;#~|&(){}\[\]])",
    re.DOTALL | re.ASCII,
)
_CONTROL = ("Else", "ElseIf", "EndIf", "EndFor", "Return")
"""What gmsh looks for, by letters, when it skips a part of a script, and behind which it goes on to read."""
_ENDS = {"(": ")", "[": "]", "{": "}"}
_ASSIGNS = ("=", "+=", "-=", "*=", "/=", "++", "--")
_NAMES_A_FILE = ("Include", "Merge", "ShapeFromFile")


class Token(NamedTuple):
    """A word, number, text or sign of a script."""

    kind: str
    text: str
    start: int
    line: int
    """From 1."""


def put_alone(path: pathlib.Path, folder: pathlib.Path) -> pathlib.Path:
    """Copy what gmsh is to open into a folder that nobody else writes to.

    There is nothing beside the copy that gmsh would read unasked, such as `part.step.opt`; its name ends as gmsh knows
    it, so that nothing else is taken for a script; and a script is copied without comments, with what it includes.

    Returns
    -------
    pathlib.Path
        Of the copy.

    Raises
    ------
    InputError
        A script with anything but what draws a geometry; with file and line.
    """
    if path.suffix.lower() in SCRIPTS:
        return _Copies(folder).script(path)
    copy = folder / f"part{path.suffix.lower()}"
    shutil.copyfile(path, copy)
    return copy


@dataclass
class _Copies:
    """The files of a script, copied one by one under names of their own."""

    folder: pathlib.Path
    names: dict[pathlib.Path, str] = field(default_factory=dict)

    def script(self, path: pathlib.Path) -> pathlib.Path:
        """Copy a script and what it names; return the copy."""
        content = path.read_bytes().decode("utf-8", "surrogateescape")
        tokens = _tokens(content, path.name)
        _check(tokens, path.name)
        copy = self._place(path, path.name)
        renamed = {
            tokens[number].start: self._copied(path, tokens, number) for number in _file_names(tokens, path.name)
        }
        copy.write_bytes(_written(tokens, renamed).encode("utf-8", "surrogateescape"))
        return copy

    def _place(self, path: pathlib.Path, name: str) -> pathlib.Path:
        place = self.folder / str(len(self.names)) / name
        self.names[path.resolve()] = f"../{place.parent.name}/{name}"
        place.parent.mkdir()
        return place

    def _copied(self, script: pathlib.Path, tokens: list[Token], number: int) -> str:
        """Name, seen from the copy of a script, of the copy of a file that the script names."""
        token, said = tokens[number], shortened(tokens[number].text)
        other = script.parent / token.text[1:-1]
        if not other.is_file():
            raise InputError(f"{script.name}, line {token.line}: there is no file {said}")
        if other.resolve() not in self.names:
            if len(self.names) >= MOST_FILES:
                raise InputError(f"{script.name}, line {token.line}: more than {MOST_FILES} files")
            suffix = other.suffix.lower()
            if suffix in SCRIPTS or tokens[number - 1].text == "Include":
                self.script(other)
            elif suffix in PARTS:
                shutil.copyfile(other, self._place(other, f"part{suffix}"))
            else:
                _refuse(script.name, token.line, f"reads {said}; it may read {', '.join((*PARTS, *SCRIPTS))}")
        return self.names[other.resolve()]


def _tokens(content: str, name: str) -> list[Token]:
    """The words of a script, as gmsh's scanner finds them, without comments."""
    found, place, line = [], 0, 1
    while place < len(content):
        match = _TOKEN.match(content, place)
        if match is None or (match.lastgroup == "sign" and content.startswith("/*", place)):
            what = f"'{shortened(content[place : place + 20])}' is not a word of gmsh, or does not end"
            raise InputError(f"{name}, line {line}: {what}")
        kind, text = str(match.lastgroup), match[0]
        if kind != "blank":
            if len(text.encode("utf-8", "surrogateescape")) > LONGEST:
                raise InputError(f"{name}, line {line}: a word or text of more than {LONGEST} bytes")
            found.append(Token(kind, text, place, line))
        line += text.count("\n")
        place = match.end()
    return found


def _written(tokens: list[Token], renamed: dict[int, str]) -> str:
    """The script without comments, on the same lines, with new names of files by the place of the old ones."""
    lines: list[list[str]] = [[]]
    line = 1
    for token in tokens:
        lines += [[] for _ in range(token.line - line)]
        line = token.line
        if sum(map(len, lines[-1])) > LONGEST_LINE:
            lines.append([])
        lines[-1].append(f'"{renamed[token.start]}"' if token.start in renamed else token.text)
    return "".join(f"{' '.join(words)}\n" for words in lines)


def _check(tokens: list[Token], name: str) -> None:
    """Refuse every statement that does more than draw."""
    for number, token in enumerate(tokens):
        if token.kind in ("word", "text"):
            _check_word(token, name)
        if token.kind != "word":
            continue
        behind = _behind(tokens, number + 1)
        option = _text(tokens, behind + 1) if _sign(tokens, behind) == "." else ""
        if option and (token.text in OTHER_OPTIONS or (token.text == "General" and option not in GENERAL)):
            _refuse(name, token.line, f"has {shortened(f'{token.text}.{option}')}")
        if _may_begin(tokens, number):
            known = token.text in KEYWORDS or token.text in COMMANDS or token.text in _NAMES_A_FILE
            if not (known or (option and token.text in OPTIONS) or _sign(tokens, behind) in _ASSIGNS):
                _refuse(name, token.line, f"says {shortened(token.text)}")
        if token.text in ("Printf", "Warning", "Error") and _sign(tokens, behind) != ";":
            _refuse(name, token.line, f"writes into a file by {token.text}")
        if token.text == "Field" and _sign(tokens, number + 1) == "[" and _sign(tokens, behind) == "=":
            kind = _text(tokens, behind + 1)
            if kind not in FIELDS:
                _refuse(name, token.line, f"makes a field {shortened(kind)}")


def _check_word(token: Token, name: str) -> None:
    """Refuse words that are never allowed, and those that gmsh may cut in two."""
    if token.kind == "word" and token.text in FORBIDDEN:
        _refuse(name, token.line, f"says {token.text}")
    cut = next((word for word in _CONTROL if word in token.text), None)
    if cut and token.text not in _CONTROL:
        _refuse(name, token.line, f"has {cut} inside of {shortened(token.text)}")


def _may_begin(tokens: list[Token], number: int) -> bool:
    """Whether gmsh may read a statement from here on, after an error too."""
    if not number:
        return True
    before = tokens[number - 1].text
    names_a_macro = number > 1 and tokens[number - 2].text in ("Macro", "Function")
    return names_a_macro or before in (";", "}", ")", "]", *_CONTROL)


def _file_names(tokens: list[Token], name: str) -> list[int]:
    """The texts that name files."""
    found = []
    for number, token in enumerate(tokens):
        if token.kind == "word" and token.text in _NAMES_A_FILE:
            place = number + 2 if token.text == "ShapeFromFile" else number + 1
            if _kind(tokens, place) != "text":
                _refuse(name, token.line, f"says {token.text} without the name of a file in quotes")
            found.append(place)
    return found


def _behind(tokens: list[Token], number: int) -> int:
    """Place behind the brackets, if any, that follow a name: `name[1]`, `name~{i}(2)`."""
    while number < len(tokens) and tokens[number].text in ("~", *_ENDS):
        if tokens[number].text == "~":
            number += 1
            continue
        open_ones = [_ENDS[tokens[number].text]]
        number += 1
        while open_ones and number < len(tokens):
            if tokens[number].text in _ENDS and tokens[number].kind == "sign":
                open_ones.append(_ENDS[tokens[number].text])
            elif tokens[number].text == open_ones[-1] and tokens[number].kind == "sign":
                open_ones.pop()
            number += 1
    return number


def _text(tokens: list[Token], number: int) -> str:
    return tokens[number].text if 0 <= number < len(tokens) else ""


def _kind(tokens: list[Token], number: int) -> str:
    return tokens[number].kind if 0 <= number < len(tokens) else ""


def _sign(tokens: list[Token], number: int) -> str:
    """A sign, but no text that looks like one."""
    return tokens[number].text if _kind(tokens, number) == "sign" else ""


def _refuse(name: str, line: int, what: str) -> NoReturn:
    raise InputError(
        f"{name}, line {line}: {what}. A script may run programs and write files, so only what draws a geometry is let "
        "through. Take it out; or, if you know what the script does, say trust_script=True (magshell mesh: "
        "--trust-script)"
    )
