"""Exact rays through volumes, and how far the schemes of volume rendering are from them.

Arrays are numpy's. Scalars are in the units of the volume; lengths along rays in voxels, in scenes in the volume's
smallest spacings; extinctions are per such a length; colours are linear light. A *document* is what the program reads
as JSON: the path of a file, or a dict or list in which arrays, numpy's numbers, paths, `Volume` and `TransferFunction`
objects may stand. `data` names folders of volumes ("A:B"), beside those of RAYTRUTH_DATA. `threads=0`: all cores.

What is refused raises `InputError` with one line: place, what was found, what is allowed. What is mended, clamped,
rounded or left out is warned of as `InputWarning`.
"""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, Literal, final

from numpy import bool_, float64, int64
from numpy.typing import ArrayLike, NDArray

__version__: str

class InputError(ValueError):
    """Bad input: what the program ends with exit code 2 for."""

class MissingError(RuntimeError):
    """Something this machine lacks, with the package to install: exit code 3."""

class OutputError(OSError):
    """The answer cannot be written: exit code 4."""

class InputWarning(UserWarning):
    """What was mended, clamped, rounded or left out."""

_Path = str | PathLike[str]
_Document = _Path | dict[str, Any] | list[Any]
_Emission = Literal["associated", "plain"]
_Interpolation = Literal["trilinear", "bspline", "bspline_prefiltered", "catmull_rom"]
_Border = Literal["half_voxel", "voxel_centres"]

def memory_limit(bytes: int | None = None) -> int:
    """Bytes that one volume, image or document may need before it is refused; sets it where given."""

@final
class Volume:
    """Scalars on a regular grid; voxel (i, j, k) has its centre at x = i, y = j, z = k."""

    def __init__(
        self,
        array: ArrayLike,
        *,
        spacing: Sequence[float] = ...,
        order: str = "zyx",
        nan: float | None = None,
        name: str = "array",
    ) -> None:
        """Copies an array of three axes of any real type, indexed [z, y, x] (numpy's habit, x fastest in C order), or
        [x, y, z] with order="xyz" (nibabel, pynrrd). `spacing` is along x, y, z in either case. NaN is refused unless
        `nan` says what it becomes; infinities are refused; whole numbers beyond 2^53 are rounded, with a warning."""

    @property
    def array(self) -> NDArray[float64]:
        """The voxels, read-only, indexed [z, y, x]; no copy."""

    @property
    def name(self) -> str: ...
    @property
    def size(self) -> tuple[int, int, int]:
        """Voxels along x, y, z."""

    @property
    def spacing(self) -> tuple[float, float, float]: ...
    @property
    def range(self) -> tuple[float, float]:
        """Smallest and largest value."""

def read_volume(
    name: str,
    *,
    spacing: Sequence[float] | None = None,
    nan: float | None = None,
    time_step: int | None = None,
    repair: bool = False,
    data: str | None = None,
) -> Volume:
    """Reads NRRD, NIfTI or .npy: a path, or the name of a volume in the folders. `repair` undoes a lost first byte."""

@final
class TransferFunction:
    """Extinction or opacity, and colour, linear between points and constant beyond them. Make it once for many rays."""

    def __init__(self, document: _Document, *, volume: Volume | None = None) -> None:
        """What a scene states as "transfer_function": {"points": [...]}, the path of a JSON file of such, or of a colour
        map or preset of another program, or {"file": path, "preset": name, "range": [low, high], ...}. Presets that
        depend on the volume need it."""

    @staticmethod
    def from_extinctions(s: ArrayLike, extinction: ArrayLike, color: ArrayLike) -> TransferFunction:
        """Points of n scalars, n extinctions >= 0 per unit of length, and colours (n, 3)."""

    @staticmethod
    def from_opacities(
        s: ArrayLike, opacity: ArrayLike, color: ArrayLike, unit_length: float = 1.0
    ) -> TransferFunction:
        """Points of n scalars, n opacities (0 to 1) of a length `unit_length`, and colours (n, 3). The opacity, not the
        extinction, is linear between them: what renderers interpolate."""

    @property
    def document(self) -> dict[str, Any]:
        """Its points, as scenes, cases and tables state them."""

    @property
    def description(self) -> Any:
        """How a file of another program was understood; None where it is none."""

    def at(self, s: ArrayLike) -> tuple[NDArray[float64], NDArray[float64]]:
        """Extinctions of the shape of s, and colours of that shape and a last axis of 3."""

@final
class Signal:
    """A scalar along a ray, from t = 0 to `length`: polynomials of degree up to 9, piece by piece."""

    def __init__(self, breaks: Sequence[float], coefficients: Sequence[Sequence[float]]) -> None:
        """Piece i is sum_k coefficients[i][k] (t - breaks[i])^k on [breaks[i], breaks[i + 1]]; breaks[0] is 0."""

    @property
    def length(self) -> float: ...
    def at(self, t: ArrayLike) -> NDArray[float64]:
        """The scalar at each t, 0 to length."""

@final
class Integral:
    """Colour and opacity of a ray, as `integral` and `slab` give it."""

    @property
    def color(self) -> list[float]:
        """Red, green, blue; opacity-weighted."""

    @property
    def opacity(self) -> float: ...
    @property
    def radius(self) -> float | None:
        """Of the certified integral: every channel and the opacity are proven to be this near. None: of a scheme."""

    @property
    def converged(self) -> bool | None:
        """Whether the radius is as small as is aimed at; it holds in either case. None: of a scheme."""

    @property
    def fetches(self) -> int:
        """Samples of the signal that a scheme reads."""

    @property
    def lookups(self) -> int: ...
    @property
    def composites(self) -> int: ...

@final
class Rays:
    """Colours and opacities of n rays."""

    @property
    def color(self) -> NDArray[float64]:
        """(n, 3), opacity-weighted."""

    @property
    def opacity(self) -> NDArray[float64]: ...
    @property
    def length(self) -> NDArray[float64]:
        """Of the part of each ray inside the volume, in voxels."""

    @property
    def radius(self) -> NDArray[float64]:
        """Proven bounds of the certified integrals; NaN of a scheme."""

    @property
    def converged(self) -> NDArray[bool_]: ...
    @property
    def fetches(self) -> NDArray[int64]: ...
    @property
    def lookups(self) -> NDArray[int64]: ...
    @property
    def composites(self) -> NDArray[int64]: ...
    def __len__(self) -> int: ...

def integral(
    signal: Signal,
    transfer_function: TransferFunction | _Document,
    *,
    scheme: str = "reference",
    step: float | None = None,
    emission: _Emission = "associated",
) -> Integral:
    """The volume rendering integral C = int_0^L q(s(t)) T(t) dt, A = 1 - T(L) along a signal: certified, or by a scheme
    (a name of `schemes()`) with samples at a constant step, or without one at pieces' borders and midpoints. `emission`
    is q = tau c (associated) or q = c (plain). The same numbers as `raytruth eval`."""

def rays(
    volume: Volume,
    transfer_function: TransferFunction | _Document,
    origins: ArrayLike,
    directions: ArrayLike,
    *,
    lengths: ArrayLike | None = None,
    scheme: str = "reference",
    step: float | None = None,
    interpolation: _Interpolation = "trilinear",
    border: _Border = "half_voxel",
    emission: _Emission = "associated",
    threads: int = 0,
) -> Rays:
    """The integrals of many rays through a volume. Origins and directions are (n, 3), or (3,) for all, in voxel
    coordinates x, y, z; directions need not have length 1; the spacing plays no part. A ray is cut to the volume, and to
    `lengths`, counted from where it enters. `border` says where the volume ends."""

def signal_along(
    volume: Volume,
    origin: Sequence[float],
    direction: Sequence[float],
    *,
    length: float | None = None,
    interpolation: _Interpolation = "trilinear",
    border: _Border = "half_voxel",
) -> Signal:
    """The scalar along one ray, in voxel coordinates: a cubic in every cell, of the tricubic ones of degree 9."""

def slab(
    transfer_function: TransferFunction | _Document,
    front: float,
    back: float,
    length: float = 1.0,
    *,
    emission: _Emission = "associated",
) -> Integral:
    """The certified integral of a slab in which the scalar is linear from `front` to `back`: an entry of a table."""

@final
class Image:
    """A rendered scene."""

    @property
    def pixels(self) -> NDArray[float64]:
        """(height, width, 4): red, green, blue in linear light over black, and opacity; row 0 on top."""

    @property
    def radius(self) -> NDArray[float64] | None:
        """(height, width), of the scheme "reference": proven without light (info["certified"]), else measured."""

    @property
    def info(self) -> dict[str, Any]:
        """What `raytruth render` prints."""

    def save(self, path: str, *, linear: bool = False, binary64: bool = False) -> None:
        """Writes .png (8 bits, sRGB or linear), .pfm or .npy."""

def render(
    scene: _Document,
    *,
    data: str | None = None,
    nan: float | None = None,
    threads: int = 0,
    progress: Callable[[int, int], object] | None = None,
) -> Image:
    """Renders a scene by the scheme that it names; "reference" is the true image. `progress(done, of)` is called now and
    then; Ctrl-C is heard."""

def read_image(path: _Path) -> NDArray[float64]:
    """(height, width, 3 or 4): the numbers of a .png (over their largest, encoded as they are), .pfm or .npy."""

def compare(reference: Image | _Path | ArrayLike, image: Image | _Path | ArrayLike, *, peak: float = 1.0) -> dict[str, Any]:
    """RMSE, PSNR, SSIM, the largest error with its pixel and more, of linear light over black."""

def advise(
    scene: _Document,
    error: float | Literal["invisible"],
    *,
    of: Literal["rmse", "largest", "encoded"] = "rmse",
    views: int = 6,
    rays: int = 16384,
    seed: int = 1,
    data: str | None = None,
    nan: float | None = None,
    threads: int = 0,
) -> dict[str, Any]:
    """The cheapest scheme, step, table and format that keep an error: result["advice"]["best"], with the next cheaper
    one beside it; result["rows"] are all ways that were compared. See `raytruth advise --help`."""

def evaluate(
    cases: _Document, *, data: str | None = None, nan: float | None = None, programs: bool = False, threads: int = 0
) -> Any:
    """What `raytruth eval` answers of a case (a ray, slab or scene), or of each of a list."""

@final
class Table:
    """A pre-integration table."""

    @property
    def values(self) -> NDArray[Any]:
        """Its numbers, in the format asked for: those of the .npy that `raytruth table` writes:
        [back scalar, front scalar, (red, green, blue, opacity)] of most builders; description["axes"] says it."""

    @property
    def description(self) -> dict[str, Any]:
        """Axes, format and the measured error of look-ups."""

def table(case: _Document, *, threads: int = 0) -> Table:
    """Makes a table as `raytruth table` does."""

def vectors(*, seed: int = 1, form: str = "vectors/2") -> dict[str, Any]:
    """The conformance vectors: rays and slabs with certified colour and opacity."""

def score(
    vectors: _Document,
    answers: _Path | dict[str, ArrayLike],
    *,
    emission: str | None = None,
    per_vector: bool = False,
) -> list[dict[str, Any]]:
    """Digits that are right, a row for each level, or each vector. `answers`: {id: (red, green, blue, opacity)}, or a CSV
    file with the header id,r,g,b,opacity."""

def available(kind: str, *, data: str | None = None) -> list[dict[str, Any]]:
    """What there is: "schemes", "shadings", "tables", "experiments", "volumes", "signals", "fields", "transfers",
    "samplings" or "measures"."""

def schemes() -> list[dict[str, Any]]:
    """available("schemes"): name, summary, source, family, orders."""

def run(
    experiment: _Document,
    *,
    folder: str | None = None,
    profile: str = "full",
    seed: int | None = None,
    gl: str | None = None,
    data: str | None = None,
    programs: bool = False,
    resume: bool = False,
    threads: int = 0,
) -> dict[str, Any]:
    """Runs an experiment: a dict, a file, or the name of one that is installed. result["rows"] is a list of flat dicts,
    which pandas.DataFrame takes; result["columns"] says what they mean. Written into `folder` where there is one."""
