# SPDX-License-Identifier: BSD-3-Clause
"""What a call is told that fits no signature: which argument is wrong, and what would be right.

Functions of the extension answer such a call with all their signatures; here the argument at fault is found.
"""

import functools
import re

from ._errors import CallError

_MISFIT = "(): incompatible function arguments"


def explain(module):
    """Functions and methods of a module, and of its classes, tell what is wrong with a call."""
    for name, value in list(vars(module).items()):
        if isinstance(value, type):
            for each, member in list(vars(value).items()):
                _replace(value, each, member, f"{name}.{each}")
        else:
            _replace(module, name, value, name)


def _replace(owner, name, function, told_name):
    kind = type(function).__name__
    if name.startswith("__") or kind not in ("nb_func", "nb_method"):
        return

    @functools.wraps(function)
    def call(*arguments, **keywords):
        try:
            return function(*arguments, **keywords)
        except TypeError as error:
            better = _better(error, told_name, function, arguments, keywords)
            if better is error:
                raise
        raise better

    call.__nb_signature__ = function.__nb_signature__
    setattr(owner, name, staticmethod(call) if kind == "nb_func" and isinstance(owner, type) else call)


def of_constructor(kind, arguments, keywords, error):
    """The exception for a call of a class."""
    return _better(error, kind.__name__, kind.__init__, (None, *arguments), keywords)


def _better(error, name, function, arguments, keywords):
    if _MISFIT not in str(error):
        return error
    signatures = [_parameters(each[0]) for each in function.__nb_signature__]
    known = [each.name for signature in signatures for each in signature if each.name != "self"]
    for keyword in keywords:
        if keyword not in known:
            return CallError(f"{name}() has no keyword `{keyword}`", f"{_nearest(keyword, known)} would be right",
                             parameter=keyword)
    faults = [_fault(name, signature, arguments, keywords) for signature in signatures]
    return min(faults, key=lambda fault: fault[0])[1]


def _nearest(word, known):
    import difflib
    names = list(dict.fromkeys(known))
    near = difflib.get_close_matches(word, names, 1, 0.6) or [each for each in names if word in each or each in word][:1]
    return f"`{near[0]}`" if near else " or ".join(filter(None, [", ".join(f"`{each}`" for each in names[:-1]),
                                                                 f"`{names[-1]}`"])) if names else "none"


class _Parameter:
    def __init__(self, text, keyword_only):
        head, self.has_default, _ = (text.partition("=") if "=" in text else (text, "", ""))
        self.name, _, self.type = (part.strip() for part in head.partition(":"))
        self.has_default, self.keyword_only = bool(self.has_default), keyword_only


def _parts(text):
    """What commas part outside of brackets."""
    depth, parts, start = 0, [], 0
    for place, letter in enumerate(text):
        depth += (letter in "([{") - (letter in ")]}")
        if letter == "," and depth == 0:
            parts.append(text[start:place].strip())
            start = place + 1
    return [*parts, text[start:].strip()]


def _parameters(signature):
    """Of "def image(self, scene: object, *, method: str = ...) -> SpectralImage"."""
    inside = re.sub(r"\s*->[^()]*$", "", signature[signature.index("(") + 1:])
    inside = inside[:inside.rindex(")")]
    result, keyword_only = [], False
    for part in _parts(inside):
        if part == "*":
            keyword_only = True
        elif part and part != "/" and not part.startswith("*"):
            result.append(_Parameter(part, keyword_only))
    return result


def _fault(name, signature, arguments, keywords):
    """How far a call came in a signature, as a rank, and what is wrong."""
    by_place = [each for each in signature if not each.keyword_only]
    if len(arguments) > len(by_place):
        rest = ", ".join(f"`{each.name}`" for each in signature if each.keyword_only)
        return 2, CallError(f"{name}() takes {_count(len(by_place) - _has_self(signature))} without a keyword",
                            rest and f"{rest} with their keywords would be right")
    given = dict(zip((each.name for each in by_place), arguments)) | keywords
    for each in signature:
        if each.name in given and each.name != "self" and not _fits(given[each.name], each.type):
            return 1, CallError(f"`{each.name}` of {name}() is a {type(given[each.name]).__name__}",
                                f"{_readable(each.type)} would be right", parameter=each.name)
    missing = [each.name for each in signature if not each.has_default and each.name not in given]
    if missing:
        return 3, CallError(f"{name}() needs `{missing[0]}`", parameter=missing[0])
    allowed = ", ".join(f"{each.name}: {_readable(each.type)}" for each in signature if each.type)
    return 4, CallError(f"what {name}() was given does not fit", f"{allowed} would be right")


def _has_self(signature):
    return bool(signature) and signature[0].name == "self"


def _count(number):
    return "no argument" if number == 0 else "one argument" if number == 1 else f"{number} arguments"


def _readable(kind):
    return re.sub(r"\b(collections\.abc|petzval\._petzval|typing|numpy\.typing)\.", "", kind).replace(" | ", " or ")


def _alternatives(kind):
    depth, parts, start = 0, [], 0
    for place, letter in enumerate(kind):
        depth += (letter in "[(") - (letter in "])")
        if letter == "|" and depth == 0:
            parts.append(kind[start:place].strip())
            start = place + 1
    return [*parts, kind[start:].strip()]


def _fits(value, kind):
    """Whether a value may be of a type; what is not known of the type fits."""
    return any(_fits_one(value, each) for each in _alternatives(kind))


def _fits_one(value, kind):
    if kind == "None":
        return value is None
    if kind == "bool":
        return isinstance(value, bool) or type(value).__name__ == "bool"
    if kind == "str":
        return isinstance(value, str)
    if kind == "int":
        return hasattr(value, "__index__")
    if kind == "float":
        return hasattr(value, "__float__") or hasattr(value, "__index__")
    outer, _, inner = kind.partition("[")
    if outer.rpartition(".")[2] in ("Sequence", "list", "tuple") and inner:
        if isinstance(value, (str, bytes)) or not hasattr(value, "__len__"):
            return False
        wanted = _parts(inner[:-1])
        if len(wanted) > 1 and wanted[-1] != "..." and len(value) != len(wanted):
            return False
        return all(_fits(each, wanted[min(place, len(wanted) - 1)]) for place, each in enumerate(list(value)[:8]))
    if outer.rpartition(".")[2] in ("Mapping", "dict"):
        return hasattr(value, "keys")
    if outer.startswith("petzval._petzval."):
        from . import _petzval
        known = getattr(_petzval, outer.rpartition(".")[2], None)
        return known is None or isinstance(value, known)
    return True
