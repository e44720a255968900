# SPDX-License-Identifier: BSD-3-Clause
"""COCO, BOP and Zarr of a data set, read back by the packages that people use, or by hand where they are missing."""

import json

import numpy as np
import petzval as pz
import pytest
from petzval import dataset

BALL = """LookAt 0 0 0  0 0 1  0 1 0
Camera "perspective" "float fov" 30
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
MakeNamedMaterial "wall" "string type" "diffuse" "rgb reflectance" [ .2 .2 .2 ]
MakeNamedMaterial "ball" "string type" "diffuse" "rgb reflectance" [ .8 .8 .8 ]
NamedMaterial "wall"
Shape "bilinearmesh" "point3 P" [ -9 -9 5   9 -9 5   -9 9 5   9 9 5 ]
NamedMaterial "ball"
AttributeBegin
Translate 0.1 0.05 2
Shape "sphere" "float radius" 0.3
AttributeEnd
"""
RECIPE = {
    "format": "petzval-dataset/1", "items": 3, "items_per_part": 2, "seed": 5,
    "parameters": {"lens": "dgauss-50mm", "world": "ball.pbrt", "sensor": "example-vga", "focus_distance_m": 2,
                   "camera_x": {"uniform": [-0.3, 0.3]}, "camera_y": 0.1, "camera_z": 0, "look_x": 0, "look_y": 0, "look_z": 2},
    "sensor_set": ["columns=48", "rows=32", "pitch_um=500"], "wavelengths_nm": "500,600", "samples_per_pixel": 4,
    "truth": ["depth", "masks", "rays"]}


@pytest.fixture(scope="module")
def items(tmp_path_factory):
    pytest.importorskip("PIL")
    folder = tmp_path_factory.mktemp("worlds")
    (folder / "ball.pbrt").write_text(BALL)
    (folder / "recipe.json").write_text(json.dumps(RECIPE))
    dataset.make(folder / "recipe.json", folder / "set")
    return dataset.Dataset(folder / "set")


def test_coco_masks_are_those_of_the_set(items, tmp_path):
    dataset.to_coco(items, tmp_path / "coco.json")
    coco = json.loads((tmp_path / "coco.json").read_text())
    assert [image["file_name"] for image in coco["images"]] == ["0000000.png", "0000001.png", "0000002.png"]
    assert len(coco["annotations"]) == 6 and len(coco["categories"]) == 2
    for each in coco["annotations"]:
        masks = items[each["image_id"]]["masks"]
        mask = masks[:, :, 0] == each["object"]
        counts = each["segmentation"]["counts"]
        runs = np.repeat(np.arange(len(counts)) % 2, counts).reshape(mask.shape[::-1]).T
        assert (runs == mask).all() and each["area"] == mask.sum()
        left, top, columns, rows = each["bbox"]
        assert mask[top:top + rows, left:left + columns].sum() == mask.sum()
        # The material of all of the object.
        assert set(masks[:, :, 1][mask]) == {each["category_id"] - 1}


def test_pycocotools_reads_it(items, tmp_path):
    coco_module = pytest.importorskip("pycocotools.coco")
    dataset.to_coco(items, tmp_path / "coco.json")
    coco = coco_module.COCO(str(tmp_path / "coco.json"))
    for each in coco.loadAnns(coco.getAnnIds()):
        mask = items[each["image_id"]]["masks"][:, :, 0] == each["object"]
        assert (coco.annToMask(each) == mask).all()


def test_bop_poses_put_the_ball_where_its_mask_is(items, tmp_path):
    image = pytest.importorskip("PIL.Image")
    dataset.to_bop(items, tmp_path / "bop")
    cameras, poses, infos = (json.loads((tmp_path / "bop" / f"{name}.json").read_text())
                             for name in ("scene_camera", "scene_gt", "scene_gt_info"))
    for key in ("0", "1", "2"):
        number = [each["obj_id"] for each in poses[key]].index(3)
        rotation = np.array(poses[key][number]["cam_R_m2c"]).reshape(3, 3)
        place = rotation @ np.array([100, 50, 2000]) + poses[key][number]["cam_t_m2c"]
        seen = np.array(cameras[key]["cam_K"]).reshape(3, 3) @ place
        mask = np.asarray(image.open(tmp_path / "bop" / "mask_visib" / f"{int(key):06d}_{number:06d}.png")) > 0
        rows, columns = np.nonzero(mask)
        assert mask.sum() == infos[key][number]["px_count_visib"]
        # Where it is all in the picture, the middle of its mask is that of the ball, to half a pixel and the pupil's
        # place of 0.05 in 2 (2.5 % of the distance from the middle of the picture, at most 12 pixels).
        if columns.min() > 0 and columns.max() < 47 and rows.min() > 0 and rows.max() < 31:
            assert seen[0] / seen[2] == pytest.approx((columns.min() + columns.max()) / 2, abs=1)
            assert seen[1] / seen[2] == pytest.approx((rows.min() + rows.max()) / 2, abs=1)
        depth_mm = np.asarray(image.open(tmp_path / "bop" / "depth" / f"{int(key):06d}.png")) * cameras[key]["depth_scale"]
        assert depth_mm[mask].min() == pytest.approx(np.linalg.norm(place) - 300, rel=0.02)


def test_zarr_has_the_arrays_item_by_item(items, tmp_path):
    dataset.to_zarr(items, tmp_path / "set.zarr", only=["depth", "masks"])
    described = json.loads((tmp_path / "set.zarr" / "masks" / ".zarray").read_text())
    assert described["shape"] == [3, 32, 48, 2] and described["chunks"] == [1, 32, 48, 2] and described["dtype"] == "<i4"
    chunk = np.frombuffer((tmp_path / "set.zarr" / "masks" / "2.0.0.0").read_bytes(), "<i4").reshape(32, 48, 2)
    assert (chunk == items[2]["masks"]).all()
    assert not (tmp_path / "set.zarr" / "rays").exists()
    with pytest.raises(pz.InputError, match="is there already"):
        dataset.to_zarr(items, tmp_path / "set.zarr")


def test_zarr_package_reads_it(items, tmp_path):
    zarr = pytest.importorskip("zarr")
    dataset.to_zarr(items, tmp_path / "set.zarr")
    group = zarr.open_group(str(tmp_path / "set.zarr"), mode="r")
    for index in range(3):
        for name in ("depth", "masks", "rays"):
            assert np.array_equal(group[name][index], items[index][name], equal_nan=name == "rays")
    assert group.attrs["facts"][1]["key"] == "0000001"


def test_what_is_missing_is_said_and_nothing_is_left(tmp_path):
    flat = {**RECIPE, "parameters": {"lens": "edmund-54852", "scene": "grid", "sensor": "example-vga"}, "truth": [], "items": 1}
    dataset.make(flat, tmp_path / "set")
    for write in (dataset.to_coco, dataset.to_bop):
        with pytest.raises(pz.InputError, match="no masks"):
            write(dataset.Dataset(tmp_path / "set"), tmp_path / "out")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["set"]


def test_dask_workers_make_the_bytes_of_one_process(items, tmp_path):
    distributed = pytest.importorskip("dask.distributed")
    recipe = items.folder.parent / "recipe.json"
    with distributed.LocalCluster(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None) as cluster, \
            distributed.Client(cluster) as client:
        assert dataset.compute(client, recipe, tmp_path / "set")["items"] == 3
    ours = {path.name: path.read_bytes() for path in (tmp_path / "set").iterdir()}
    assert ours == {path.name: path.read_bytes() for path in items.folder.iterdir()}


def test_pieces_of_a_picture_are_one_process(tmp_path):
    (tmp_path / "ball.pbrt").write_text(BALL)
    camera = pz.Camera("dgauss-50mm", focus="2m")
    shared = dict(scene=str(tmp_path / "ball.pbrt"), size=(40, 30), wavelengths_nm=[500, 600], samples_per_pixel=8, seed=3)
    whole = camera.render(**shared, checkpoint=str(tmp_path / "whole"))
    camera.render(**shared, region=(0, 0, 17, 30), checkpoint=str(tmp_path / "a"))
    camera.render(**shared, region=(17, 0, 23, 30), sample_range=(0, 4), checkpoint=str(tmp_path / "b"))
    camera.render(**shared, region=(17, 0, 23, 30), sample_range=(4, 8), checkpoint=str(tmp_path / "c"))
    pz.merge_renderings([str(tmp_path / name) for name in "cab"], str(tmp_path / "merged"))
    assert (tmp_path / "merged").read_bytes() == (tmp_path / "whole").read_bytes()
    again = camera.render(**shared, checkpoint=str(tmp_path / "merged"))
    assert np.array_equal(np.asarray(again.light), np.asarray(whole.light))
    with pytest.raises(pz.InputError, match="no piece has pixel 17,0"):
        pz.merge_renderings([str(tmp_path / "a")], str(tmp_path / "none"))


def test_bands_of_an_image_are_one_process(tmp_path):
    camera = pz.Camera("edmund-54852", sensor="40x30@15")
    shared = dict(scene=pz.SceneRequest("studio", wavelengths_nm=[450, 550, 650]), tolerance=1e-2)
    whole = camera.image(**shared)
    for name, bands in (("a", (0, 2)), ("b", (2, 3))):
        camera.image_piece(**shared, bands=bands, checkpoint=str(tmp_path / name))
    pz.merge_images([str(tmp_path / name) for name in "ba"], str(tmp_path / "merged"))
    again = camera.image(**shared, checkpoint=str(tmp_path / "merged"))
    assert np.array_equal(np.asarray(again), np.asarray(whole))
    with pytest.raises(pz.InputError, match="has bands 0 to 1 of 3"):
        camera.image(**shared, checkpoint=str(tmp_path / "a"))


def test_parquet_has_the_lines_of_facts(items, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    dataset.to_parquet(items, tmp_path / "set.parquet")
    rows = parquet.read_table(tmp_path / "set.parquet").to_pylist()
    assert [row["key"] for row in rows] == [items.facts(index)["key"] for index in range(3)]
    for index, row in enumerate(rows):
        assert row["parameters"]["camera_x"] == items.facts(index)["parameters"]["camera_x"]
        assert row["files"]["png"] == items.facts(index)["files"]["png"]
        assert row["archive"] == items.archive(index).name
