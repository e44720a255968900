# SPDX-License-Identifier: BSD-3-Clause
"""Data sets with ground truth (docs/DATASETS.md): many pictures through many lenses and sensors.

    from petzval import dataset
    dataset.make("recipe.json", "set")
    items = dataset.Dataset("set")
    items[0]["picture"], items[0]["psf"], items[0]["facts"]["parameters"]
"""

import bisect
import io
import json
import os
import pathlib

import numpy as np

from ._dataset_formats import to_bop, to_coco, to_parquet, to_zarr
from ._errors import InputError
from ._petzval import _dataset_parts, _dataset_state, _estimate_dataset, _make_dataset, _verify_dataset

__all__ = ["Dataset", "compute", "estimate", "info", "make", "to_bop", "to_coco", "to_parquet", "to_zarr",
           "verify"]


def _recipe(recipe):
    """Text, name for messages, and the folder that relative names of files start from."""
    if isinstance(recipe, dict):
        return json.dumps(recipe), "recipe", ""
    path = pathlib.Path(recipe)
    try:
        return path.read_text(encoding="utf-8"), str(path), str(path.parent)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror}") from None


def make(recipe, folder, *, shard=(0, 1), threads=0, progress=None):
    """Makes a data set, or goes on with one.

    `recipe`: a file, or a dict of what such a file holds. `shard`: (index, count): every count-th part, from part
    `index` (from 0) on. Gives a dict: parts of the shard, those kept from earlier and those in the making by another
    process; items made now, how many of them failed, and bytes. Raises InputError for a recipe that is wrong and for
    a folder that holds another data set, Cancelled when `progress(fraction, what)` gives False: whole parts are kept.
    """
    return _make_dataset(*_recipe(recipe), os.fspath(folder), shard[0], shard[1], threads, progress)


def info(folder):
    """What a folder holds: made_by, recipe (a dict), items, parts, parts_done, items_done, failed, bytes, errors."""
    state = _dataset_state(os.fspath(folder))
    return {**state, "recipe": json.loads(state["recipe"])}


def verify(folder, *, threads=0, progress=None):
    """Reads every byte and gives what is wrong, a line each; an empty list if all is well."""
    return _verify_dataset(os.fspath(folder), threads, progress)


def estimate(recipe, probes=8, *, threads=0, progress=None):
    """CPU seconds and bytes an item, and memory of a process with so many threads (of this one, with all that it
    holds already), from items that are made and thrown away.
    """
    return _estimate_dataset(*_recipe(recipe), probes, threads, progress)


def compute(client, recipe, folder, *, threads=1):
    """Makes a data set on the workers of a Dask client (dask.distributed), a task a part; `folder` and the files of
    the recipe are seen by all of them under the same names. Gives the sums of what make() gives.
    """
    parts = _dataset_parts(*_recipe(recipe))
    futures = [client.submit(make, recipe, folder, shard=(part, parts), threads=threads, pure=False)
               for part in range(parts)]
    results = client.gather(futures)
    return {key: sum(result[key] for result in results) for key in results[0]}


class Dataset:
    """The items of the parts that are done, in order: a sequence of dicts, as torch.utils.data.DataLoader takes it.

    Each has "facts" (what was drawn, camera, exposure), "picture" (rows x columns x 3, uint8 or uint16) and what the
    recipe names as truth: "sharp", "psf", "rays", "depth", "normals", "albedo", "masks", "flow", "electrons", "irradiance" as arrays,
    "raw" as the bytes of a .dng. `only`: read just these. `transform(item)`: what is given in an item's place.
    Pictures need Pillow. Items that failed are left out.
    """

    _names = {"png": "picture", "sharp.png": "sharp", "dng": "raw"}

    def __init__(self, folder, only=None, transform=None):
        self.folder = pathlib.Path(folder)
        self.only = None if only is None else set(only)
        self.transform = transform
        info(folder)  # refuses what is none
        self._places = []  # facts of every item
        self._starts, self._archives = [], []  # of every part: its first item, its archive
        for sums in sorted(self.folder.glob("part-*.json")):
            facts = [json.loads(line) for line in sums.with_suffix(".jsonl").read_text().splitlines()]
            facts = [line for line in facts if "files" in line]
            if facts:
                self._starts.append(len(self._places))
                self._archives.append(sums.with_suffix(".tar"))
                self._places.extend(facts)
        self._offsets = {}  # of an archive's files, found when it is first read

    def __len__(self):
        return len(self._places)

    def facts(self, index):
        """What is known of an item, without reading its files."""
        return self._places[index]

    def archive(self, index):
        """The .tar that holds an item."""
        return self._archives[bisect.bisect_right(self._starts, index % len(self)) - 1]

    def __getitem__(self, index):
        if not -len(self) <= index < len(self):
            raise IndexError(index)
        index %= len(self)
        facts = self._places[index]
        archive = self.archive(index)
        item = {"facts": facts}
        with open(archive, "rb") as file:
            for extension, (start, size) in self._files(archive, file)[facts["key"]].items():
                name = self._names.get(extension, extension.removesuffix(".npy"))
                if extension == "json" or (self.only is not None and name not in self.only):
                    continue
                file.seek(start)
                item[name] = self._decoded(extension, file.read(size))
        return item if self.transform is None else self.transform(item)

    def _files(self, archive, file):
        if archive not in self._offsets:
            import tarfile
            found = {}
            with tarfile.open(fileobj=file, mode="r:") as members:
                for member in members:
                    key, _, extension = member.name.partition(".")
                    found.setdefault(key, {})[extension] = (member.offset_data, member.size)
            self._offsets[archive] = found
        return self._offsets[archive]

    @staticmethod
    def _decoded(extension, data):
        if extension.endswith("npy"):
            return np.load(io.BytesIO(data))
        if extension.endswith("png"):
            try:
                from PIL import Image
            except ImportError:
                raise ImportError("pictures need Pillow: pip install pillow") from None
            return np.asarray(Image.open(io.BytesIO(data)))
        return data
