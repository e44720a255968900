# SPDX-License-Identifier: BSD-3-Clause
"""What other programs read of a data set: COCO, BOP, Zarr and Parquet."""

import itertools
import json
import os
import pathlib
import tempfile

import numpy as np

from ._errors import InputError


def _new_folder(path):
    path = pathlib.Path(path)
    if path.exists():
        raise InputError(f"{path}: is there already; another name would be right")
    return path


class _Whole:
    """A folder that appears whole or not at all."""

    def __init__(self, path):
        self.path = _new_folder(path)

    def __enter__(self):
        self.path.parent.mkdir(parents=True, exist_ok=True)
        self._making = tempfile.TemporaryDirectory(prefix=f".{self.path.name}.", dir=self.path.parent)
        inner = pathlib.Path(self._making.name) / "whole"
        inner.mkdir()
        return inner

    def __exit__(self, kind, *_):
        try:
            if kind is None:
                os.rename(pathlib.Path(self._making.name) / "whole", self.path)
        finally:
            self._making.cleanup()


def _write_whole(path, text):
    path = pathlib.Path(path)
    making = path.with_name(f".{path.name}.making")
    try:
        making.write_text(text, encoding="utf-8")
        os.replace(making, path)
    finally:
        making.unlink(missing_ok=True)


def _png(path, pixels):
    from PIL import Image
    Image.fromarray(pixels).save(path)


def _run_lengths(mask):
    """COCO's: down the columns, beginning with those outside."""
    flat = mask.ravel(order="F")
    edges = np.flatnonzero(np.diff(flat)) + 1
    runs = np.diff(np.concatenate([[0], edges, [flat.size]]))
    return ([0] if flat[0] else []) + runs.tolist()


def _pictures(dataset, items, names):
    for index in range(len(items)):
        if "masks" not in names or "masks.npy" in items.facts(index)["files"]:
            yield index, items[index]
        else:
            raise InputError(f"{dataset}: has no masks; \"masks\" in the recipe's truth would be right")


def to_coco(items, path):
    """COCO annotations (object detection and segmentation) of a Dataset of 3-D worlds with masks, as one .json.

    A category is a material of the scene, an annotation an object that is seen: its box, its area and its mask as
    run lengths. Pictures are named as in the archives (0000000.png).
    """
    images, annotations, categories = [], [], set()
    for index, item in _pictures(items.folder, items, {"masks"}):
        facts, masks = item["facts"], item["masks"]
        images.append({"id": facts["item"], "file_name": facts["key"] + ".png", "width": facts["picture"]["columns"],
                       "height": facts["picture"]["rows"]})
        for seen in facts["objects"]:
            mask = masks[:, :, 0] == seen["object"]
            materials, counts = np.unique(masks[:, :, 1][mask], return_counts=True)
            material = int(materials[np.argmax(counts)])
            categories.add(material)
            annotations.append({"id": len(annotations) + 1, "image_id": facts["item"], "category_id": material + 1,
                                "object": seen["object"], "bbox": seen["box_px"], "area": int(mask.sum()), "iscrowd": 0,
                                "segmentation": {"size": list(mask.shape), "counts": _run_lengths(mask)}})
    _write_whole(path, json.dumps({
        "info": {"description": f"petzval data set {items.folder.name}"}, "images": images, "annotations": annotations,
        "categories": [{"id": material + 1, "name": f"material {material}"} for material in sorted(categories)]}))


def to_bop(items, folder):
    """A Dataset of 3-D worlds with masks and depth as a scene in BOP's layout (scene_camera.json, scene_gt.json,
    scene_gt_info.json, rgb/, depth/, mask_visib/).

    The world stands for BOP's model: `cam_R_m2c` and `cam_t_m2c` are its pose seen from the camera (x right, y down,
    z forward, mm), the same for all objects of a picture, obj_id the object's number plus one. Depth is 16 bits in
    units of `depth_scale` mm. `cam_K` is the fitted camera matrix, where the recipe has "rays"; what it leaves is
    `distortion`, as OpenCV has it.
    """
    cameras, poses, infos = {}, {}, {}
    with _Whole(folder) as out:
        for name in ("rgb", "depth", "mask_visib"):
            (out / name).mkdir()
        for index, item in _pictures(items.folder, items, {"masks"}):
            facts, masks = item["facts"], item["masks"]
            key = str(facts["item"])
            name = f"{facts['item']:06d}"
            _png(out / "rgb" / f"{name}.png", item["picture"])
            camera = {}
            if "depth" in item:
                depth_mm = np.where(np.isfinite(item["depth"]), item["depth"] * 1000.0, 0)
                camera["depth_scale"] = float(max(depth_mm.max(), 1) / 65535)
                _png(out / "depth" / f"{name}.png", np.round(depth_mm / camera["depth_scale"]).astype(np.uint16))
            if "intrinsics" in facts:
                fit = facts["intrinsics"]
                camera["cam_K"] = [fit["fx_px"], 0, fit["cx_px"], 0, fit["fy_px"], fit["cy_px"], 0, 0, 1]
                camera["distortion"] = {"model": fit["model"], "radial": fit["radial"]}
            # Camera space of Petzval has y up.
            world_from_camera = np.array(facts["camera"]["world_from_camera"]) @ np.diag([1.0, -1.0, 1.0, 1.0])
            camera_from_world = np.linalg.inv(world_from_camera)
            rotation = camera_from_world[:3, :3].ravel().tolist()
            place = (camera_from_world[:3, 3] * facts["camera"]["scene_unit_mm"]).tolist()
            camera["cam_R_w2c"], camera["cam_t_w2c"] = rotation, place
            cameras[key] = camera
            poses[key], infos[key] = [], []
            for number, seen in enumerate(facts["objects"]):
                mask = masks[:, :, 0] == seen["object"]
                _png(out / "mask_visib" / f"{name}_{number:06d}.png", mask.astype(np.uint8) * 255)
                poses[key].append({"obj_id": seen["object"] + 1, "cam_R_m2c": rotation, "cam_t_m2c": place})
                infos[key].append({"bbox_visib": seen["box_px"], "px_count_visib": seen["pixels"]})
        for name, content in (("scene_camera", cameras), ("scene_gt", poses), ("scene_gt_info", infos)):
            (out / f"{name}.json").write_text(json.dumps(content))


def to_zarr(items, folder, only=None):
    """The arrays of a Dataset as a Zarr group (version 2), an array a kind of truth, a chunk an item.

    Item first: "psf" of shape (items, grid rows, grid columns, bands, rows, columns), "irradiance" of (items, rows,
    columns, bands) and so on; "facts" of the group's attributes has a line for each item. `only`: names of arrays.
    Arrays whose shape changes from item to item are refused. Chunks are written here, uncompressed, which needs no
    package; any reader of Zarr takes them.
    """
    shapes, kinds, count = {}, {}, len(items)
    with _Whole(folder) as out:
        lines = []
        for index in range(count):
            item = items[index]
            lines.append(item["facts"])
            for name, value in item.items():
                if not isinstance(value, np.ndarray) or (only is not None and name not in only):
                    continue
                value = np.ascontiguousarray(value)
                value = value.astype(value.dtype.newbyteorder("<"), copy=False)
                if shapes.setdefault(name, value.shape) != value.shape or kinds.setdefault(name, value.dtype) != value.dtype:
                    raise InputError(f"{items.folder}: \"{name}\" of item {item['facts']['item']} has shape {value.shape}, "
                                     f"of others {shapes[name]}; only={sorted(shapes.keys() - {name})} would be right")
                (out / name).mkdir(exist_ok=True)
                chunk = ".".join(str(number) for number in itertools.chain([index], itertools.repeat(0, value.ndim)))
                (out / name / chunk).write_bytes(value.tobytes())
        for name, shape in shapes.items():
            described = {"zarr_format": 2, "shape": [count, *shape], "chunks": [1, *shape], "dtype": kinds[name].str,
                         "compressor": None, "fill_value": 0, "order": "C", "filters": None}
            (out / name / ".zarray").write_text(json.dumps(described))
        (out / ".zgroup").write_text(json.dumps({"zarr_format": 2}))
        (out / ".zattrs").write_text(json.dumps({"facts": lines}))


def to_parquet(items, path):
    """The manifest of a Dataset as one Parquet file, a row an item: the lines of facts as columns (item, key, parameters,
    lens, picture, files with sizes and sums, ...) and `archive`, the file of the folder that has it. Needs pyarrow.
    """
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError:
        raise ImportError("Parquet needs pyarrow: pip install pyarrow") from None
    rows = [{**items.facts(index), "archive": items.archive(index).name} for index in range(len(items))]
    path = pathlib.Path(path)
    making = path.with_name(f".{path.name}.making")
    try:
        parquet.write_table(pyarrow.Table.from_pylist(rows), making)
        os.replace(making, path)
    finally:
        making.unlink(missing_ok=True)
