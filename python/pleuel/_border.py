"""The functions of libpleuel.so (include/pleuel.h) by ctypes, with errors as exceptions."""

from __future__ import annotations

import contextlib
import ctypes as c
import json
import os
import pathlib
import signal
import threading
from typing import Optional

from . import errors

LIBRARY = "libpleuel.so.0"
(VARIABLES, RESPONSES, LIMITS, CASES, BODIES, JOINTS, OBJECTIVE) = range(7)
OK, FAULT, BAD_INPUT, SIMULATION_FAILED, STOPPED, BAD_CALL = range(6)

_exceptions = {
    FAULT: errors.Fault,
    BAD_INPUT: errors.InputError,
    SIMULATION_FAILED: errors.SimulationError,
    STOPPED: errors.Stopped,
    BAD_CALL: errors.CallError,
}


class _CError(c.Structure):
    _fields_ = [("kind", c.c_int), *((name, c.c_char_p) for name in ("file", "pointer", "rule", "text"))]


class Progress(c.Structure):
    """pleuel_progress"""

    _fields_ = [
        ("evaluation", c.c_int),
        ("iteration", c.c_int),
        ("variables", c.c_size_t),
        ("limits", c.c_size_t),
        ("x", c.POINTER(c.c_double)),
        ("objective", c.c_double),
        ("values", c.POINTER(c.c_double)),
        ("max_violation", c.c_double),
        ("failure", c.c_char_p),
    ]


class Search(c.Structure):
    """pleuel_search"""

    _fields_ = [
        ("number", c.c_uint64),
        ("variables", c.c_size_t),
        ("inequalities", c.c_size_t),
        ("equalities", c.c_size_t),
        ("start", c.POINTER(c.c_double)),
        ("lower", c.POINTER(c.c_double)),
        ("upper", c.POINTER(c.c_double)),
        ("tolerance", c.c_double),
    ]


REASON_SIZE = 256
BACKEND = c.CFUNCTYPE(c.c_int, c.POINTER(Search), c.POINTER(c.c_double), c.POINTER(c.c_char), c.c_void_p)
OBSERVER = c.CFUNCTYPE(c.c_int, c.POINTER(Progress), c.c_void_p)
BODY_MAKER = c.CFUNCTYPE(c.c_int, c.POINTER(c.c_double), c.c_size_t, c.POINTER(c.c_char_p), c.c_void_p)

_text, _size, _numbers, _problem = c.c_char_p, c.c_size_t, c.c_void_p, c.c_uint64
_texts, _size_out, _text_out = c.POINTER(c.c_char_p), c.POINTER(c.c_size_t), c.POINTER(c.c_char_p)
_owned_out = c.POINTER(c.c_void_p)
_arguments = {
    "pleuel_open": [_text, _text, _texts, _size, _text, c.POINTER(_problem)],
    "pleuel_close": [_problem],
    "pleuel_count": [_problem, c.c_int, _size_out],
    "pleuel_name": [_problem, c.c_int, _size, _text_out],
    "pleuel_unit": [_problem, c.c_int, _size, _text_out],
    "pleuel_bounds": [_problem, _numbers, _numbers, _numbers, _size],
    "pleuel_limits": [_problem, _numbers, _numbers, _size],
    "pleuel_evaluate": [_problem, _numbers, _size, _numbers, _numbers, _size, _numbers, _numbers],
    "pleuel_responses": [_problem, _numbers, _size, _numbers, _size, _numbers],
    "pleuel_history_size": [_problem, _numbers, _size, _size, _size_out],
    "pleuel_history": [_problem, _numbers, _size, _size, _numbers, _numbers, _size, _numbers],
    "pleuel_motion": [_problem, _numbers, _size, _owned_out],
    "pleuel_by_invariants": [_problem, _numbers, _size, _text, _owned_out],
    "pleuel_optimize": [_problem, _numbers, _size, _text, OBSERVER, c.c_void_p, _owned_out],
    "pleuel_register_backend": [_text, c.c_int, BACKEND, c.c_void_p],
    "pleuel_search_evaluate": [c.c_uint64, _numbers, _size, _numbers, _numbers, _size, _numbers, _numbers],
    "pleuel_register_body": [_text, BODY_MAKER, c.c_void_p],
    "pleuel_allow_programs": [c.c_int],
    "pleuel_run": [_texts, _size, c.POINTER(c.c_int), _owned_out],
    "pleuel_main": [c.c_int, _texts],
    "pleuel_version": [],
    "pleuel_last_error": [],
    "pleuel_free": [c.c_void_p],
    "pleuel_stop": [],
}
_results = {"pleuel_version": _text, "pleuel_last_error": c.POINTER(_CError), "pleuel_free": None, "pleuel_stop": None}


def _candidates():
    """Where the library may be: named by the environment, in the package, in the checkout, in the system."""
    if given := os.environ.get("PLEUEL_LIBRARY"):
        return [given]
    folder = pathlib.Path(__file__).resolve().parent
    places = [folder / LIBRARY, folder.parents[1] / "build" / "release" / "lib" / LIBRARY]
    return [str(place) for place in places if place.exists()] + [LIBRARY]


def _load() -> c.CDLL:
    name = _candidates()[0]
    try:
        library = c.CDLL(name)
    except OSError as error:
        raise ImportError(
            f"{name} cannot be loaded ({error}); install the package libpleuel0, or let the variable "
            "PLEUEL_LIBRARY of the environment name the file"
        ) from None
    for function, arguments in _arguments.items():
        getattr(library, function).argtypes = arguments
        getattr(library, function).restype = _results.get(function, c.c_int)
    return library


library = _load()
_libc = c.CDLL(None)
_libc.signal.argtypes, _libc.signal.restype = [c.c_int, c.c_void_p], c.c_void_p
_stop = c.cast(library.pleuel_stop, c.c_void_p)
_stop_was_asked = threading.Event()


def stop() -> None:
    """Asks all calls of this process that run now to end: they raise Stopped, optimizations return what they have."""
    _stop_was_asked.set()
    library.pleuel_stop()


@contextlib.contextmanager
def stopped_by_interrupts():
    """Ctrl-C reaches the library while a call lasts: Python itself would hear of it when that has ended."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    _stop_was_asked.clear()
    before = _libc.signal(signal.SIGINT, _stop)
    try:
        yield
    finally:
        _libc.signal(signal.SIGINT, before)


def was_interrupted() -> bool:
    """Whether a call that was stopped was stopped by Ctrl-C."""
    return not _stop_was_asked.is_set() and threading.current_thread() is threading.main_thread()


_of_callbacks = threading.local()


def keep_failure(failure: BaseException) -> None:
    """What a function raised that the library has called: the cause of the failure of the call that runs."""
    _of_callbacks.failure = failure


def _take_failure() -> Optional[BaseException]:
    failure, _of_callbacks.failure = getattr(_of_callbacks, "failure", None), None
    return failure


def checked(status: int) -> None:
    """Raises what a status says."""
    if status == OK:
        return
    if status == STOPPED and was_interrupted():
        raise KeyboardInterrupt
    error = library.pleuel_last_error().contents
    texts = [getattr(error, name).decode(errors="replace") for name in ("text", "file", "pointer", "rule")]
    raise _exceptions[status](*texts) from _take_failure()


def call(name: str, *arguments) -> None:
    """A function that may take long."""
    with stopped_by_interrupts():
        status = getattr(library, name)(*arguments)
    checked(status)


def c_texts(texts):
    """char *const *"""
    return (c.c_char_p * len(texts))(*(text.encode() for text in texts))


def taken(pointer: c.c_void_p):
    """The JSON document that a function returned, which is given back."""
    try:
        return json.loads(c.string_at(pointer.value))
    finally:
        library.pleuel_free(pointer)
