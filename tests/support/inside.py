"""What tests know of the inside of hypcheck, in one place: if a module or a function moves, this file alone changes.

What at most two test modules use they import themselves.
"""

from __future__ import annotations

from hypcheck.geometry.arithmetic import octave, shortened, sign_with_root
from hypcheck.kernel import choice as kernel_choice
from hypcheck.kernel import classify as kernel_classify
from hypcheck.kernel import compiled_kernel, core, numpy_kernel, scene_index, scene_lines
from hypcheck.kernel.choice import (
    EXTENSION,
    LEVELS,
    NUMBER_OF,
    POSITION_OF,
    KernelChoice,
    choice,
    compiled,
    most_threads,
)
from hypcheck.kernel.classify import classify
from hypcheck.kernel.compiled_kernel import answer_sweeps
from hypcheck.kernel.core import HEADER, generate
from hypcheck.kernel.core.generate import TARGET, header
from hypcheck.kernel.emission.dialects import LANGUAGES as EMITTED_LANGUAGES
from hypcheck.kernel.emission.dialects import dialect_of
from hypcheck.kernel.emission.kernel import description, emitted, emitted_whole, whole_plan
from hypcheck.kernel.emission.pair import UPRIGHT as METHODS
from hypcheck.kernel.emission.pair import emitted_pair
from hypcheck.kernel.emission.plan_text import (
    comment_text,
    operations_before,
    plan_as_json,
    plan_lines,
    printed_operations,
)
from hypcheck.kernel.in_use import kernel
from hypcheck.kernel.integers import position as integers_whole_position
from hypcheck.kernel.integers import upright_position as integers_position
from hypcheck.kernel.numpy_kernel import Buffers, chunks, positions_of_scene
from hypcheck.kernel.numpy_kernel import answer_sweeps as numpy_kernel_answer_sweeps
from hypcheck.kernel.numpy_kernel import positions as numpy_kernel_positions
from hypcheck.kernel.programs import certified, lines, tilted
from hypcheck.kernel.programs.certified import CERTIFIED, SLACK, U
from hypcheck.kernel.programs.certified import CONSTANTS as CERTIFIED_CONSTANTS
from hypcheck.kernel.programs.integers import (
    COEFFICIENTS,
    DISCRIMINANT,
    FLOAT64_BITS,
    INTEGERS,
    INVARIANTS,
    QUARTIC,
    bits_counted,
)
from hypcheck.kernel.programs.tilted import CONSTANTS, TILTED
from hypcheck.kernel.scalar import exact_position
from hypcheck.kernel.scalar import position as scalar_position
from hypcheck.kernel.scene import Scene
from hypcheck.kernel.specialise import last_stages
from hypcheck.kernel.specialise.first_stages import AXIAL, RADIAL, Thresholds, entry, line_at, thresholds
from hypcheck.kernel.specialise.last_stages import (
    TiltedSearch,
    backward_bound,
    discriminant,
    exact_constants,
    search,
    search_begin,
    tilted_search,
)
from hypcheck.kernel.specialise.plan import ONE_SIDED, ScenePlan, Stages, decided_by, far_corner, plan_of
from hypcheck.kernel.specialise.settings import (
    FORMATS,
    ScaledSetting,
    Setting,
    centres,
    position_of_box,
    scaled,
    settings_of,
)
from hypcheck.truth import (
    backward_error,
    exact,
    float_filter,
    least,
    nearest_rows,
    passage_error,
    swept,
)
from hypcheck.truth import nearest as truth_nearest
from hypcheck.truth.backward_error import (
    Bracket,
    bracket,
    distance_exponents,
    estimate,
    exponent,
    flip_exponents,
    lower_ends,
    quick_bracket,
    tolerated,
)
from hypcheck.truth.certificate import (
    Certificate,
    PassageCertificate,
    Piece,
    check_certificate,
    check_passage,
    clear_until,
    contact_at,
    pivots,
    proves,
    surfaces,
)
from hypcheck.truth.certificate import place as certificate_place
from hypcheck.truth.changes import corner, goal_of
from hypcheck.truth.ended_error import clearance as ended_clearance
from hypcheck.truth.ended_error import enclosure as ended_enclosure
from hypcheck.truth.exact import Decision, decide, kind_of, position
from hypcheck.truth.exact import cubic as exact_cubic
from hypcheck.truth.exact import discriminant as exact_discriminant
from hypcheck.truth.float_filter import filtered, lines_for_sizes, positions
from hypcheck.truth.kinds import Kind
from hypcheck.truth.least import position as least_position
from hypcheck.truth.mesh import MeshOutcome, availability, distance_to_mesh
from hypcheck.truth.mesh_oracle import verdict
from hypcheck.truth.nearest import Enclosure, NearestStage, nearest, ratio
from hypcheck.truth.nearest_rows import clearances
from hypcheck.truth.nearest_rows import positions as nearest_rows_positions
from hypcheck.truth.passage_error import (
    hits_at_size,
    is_tolerated,
    passage_of,
    size_error,
    time_is_within,
    tolerance,
)
from hypcheck.truth.pencil import cubic, quartic
from hypcheck.truth.polynomials import _none_by_descartes, linear_factor, polynomial_product, sign_at, value
from hypcheck.truth.prove import prove
from hypcheck.truth.roots import (
    COMPLEX,
    KIND_OF,
    PATTERNS,
    Invariants,
    RootPlace,
    classify_by_roots,
    classify_invariants,
    coefficients,
    real_roots,
)
from hypcheck.truth.sections import position as heights_position
from hypcheck.truth.sweep import piece, sign_at_root
from hypcheck.truth.swept import WIDTH_BITS, by_roots, by_steps, passage, passage_of_row, reach, steps, sweep_of

__all__ = [
    "AXIAL",
    "CERTIFIED",
    "CERTIFIED_CONSTANTS",
    "COEFFICIENTS",
    "COMPLEX",
    "CONSTANTS",
    "DISCRIMINANT",
    "EMITTED_LANGUAGES",
    "EXTENSION",
    "FLOAT64_BITS",
    "FORMATS",
    "HEADER",
    "INTEGERS",
    "INVARIANTS",
    "KIND_OF",
    "LEVELS",
    "METHODS",
    "NUMBER_OF",
    "ONE_SIDED",
    "PATTERNS",
    "POSITION_OF",
    "QUARTIC",
    "RADIAL",
    "SLACK",
    "TARGET",
    "TILTED",
    "WIDTH_BITS",
    "Bracket",
    "Buffers",
    "Certificate",
    "Decision",
    "Enclosure",
    "Invariants",
    "KernelChoice",
    "Kind",
    "MeshOutcome",
    "NearestStage",
    "PassageCertificate",
    "Piece",
    "RootPlace",
    "ScaledSetting",
    "Scene",
    "ScenePlan",
    "Setting",
    "Stages",
    "Thresholds",
    "TiltedSearch",
    "U",
    "_none_by_descartes",
    "answer_sweeps",
    "availability",
    "backward_bound",
    "backward_error",
    "bits_counted",
    "bracket",
    "by_roots",
    "by_steps",
    "centres",
    "certificate_place",
    "certified",
    "check_certificate",
    "check_passage",
    "choice",
    "chunks",
    "classify",
    "classify_by_roots",
    "classify_invariants",
    "clear_until",
    "clearances",
    "coefficients",
    "comment_text",
    "compiled",
    "compiled_kernel",
    "contact_at",
    "core",
    "corner",
    "cubic",
    "decide",
    "decided_by",
    "description",
    "dialect_of",
    "discriminant",
    "distance_exponents",
    "distance_to_mesh",
    "emitted",
    "emitted_pair",
    "emitted_whole",
    "ended_clearance",
    "ended_enclosure",
    "entry",
    "estimate",
    "exact",
    "exact_constants",
    "exact_cubic",
    "exact_discriminant",
    "exact_position",
    "exponent",
    "far_corner",
    "filtered",
    "flip_exponents",
    "float_filter",
    "generate",
    "goal_of",
    "header",
    "heights_position",
    "hits_at_size",
    "integers_position",
    "integers_whole_position",
    "is_tolerated",
    "kernel",
    "kernel_choice",
    "kernel_classify",
    "kind_of",
    "last_stages",
    "least",
    "least_position",
    "line_at",
    "linear_factor",
    "lines",
    "lines_for_sizes",
    "lower_ends",
    "most_threads",
    "nearest",
    "nearest_rows",
    "nearest_rows_positions",
    "numpy_kernel",
    "numpy_kernel_answer_sweeps",
    "numpy_kernel_positions",
    "octave",
    "operations_before",
    "passage",
    "passage_error",
    "passage_of",
    "passage_of_row",
    "piece",
    "pivots",
    "plan_as_json",
    "plan_lines",
    "plan_of",
    "polynomial_product",
    "position",
    "position_of_box",
    "positions",
    "positions_of_scene",
    "printed_operations",
    "prove",
    "proves",
    "quartic",
    "quick_bracket",
    "ratio",
    "reach",
    "real_roots",
    "scalar_position",
    "scaled",
    "scene_index",
    "scene_lines",
    "search",
    "search_begin",
    "settings_of",
    "shortened",
    "sign_at",
    "sign_at_root",
    "sign_with_root",
    "size_error",
    "steps",
    "surfaces",
    "sweep_of",
    "swept",
    "thresholds",
    "tilted",
    "tilted_search",
    "time_is_within",
    "tolerance",
    "tolerated",
    "truth_nearest",
    "value",
    "verdict",
    "whole_plan",
]
