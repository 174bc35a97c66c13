"""Rendered pairs, and masks from a rectangle."""

import numpy as np

import bimodal_stereo as bimodal
from conftest import refused


def test_a_pair_is_a_pair_with_masks_cameras_and_its_pose():
    pair = bimodal.sample_pair("bust")
    assert pair.name == "bust" and pair.pose.scale == 1
    assert pair.image.data.shape[:2] == pair.image.mask.shape and pair.depth.data.shape == pair.depth.mask.shape
    assert pair.image.data.dtype == np.uint8 and pair.depth.data.dtype == np.uint16 and pair.depth.unit == 0.001
    refused(lambda: bimodal.sample_pair("teapot"), "option", "kind")


def test_a_disc_is_found_from_a_rectangle(rng):
    rows, columns = np.indices((120, 160))
    disc = (columns - 80) ** 2 + (rows - 60) ** 2 < 40**2
    colours = np.where(disc[..., None], [170, 90, 60], [80, 110, 140]) + rng.normal(scale=10, size=(120, 160, 3))
    marks = np.where((np.abs(columns - 80) < 65) & (np.abs(rows - 60) < 50), 3, 0)
    found = bimodal.suggest_mask(colours.clip(0, 255).astype(np.uint8), marks)
    assert found.mask.dtype == bool and 0 < found.rounds <= 12
    assert (found.mask & disc).sum() > 0.97 * (found.mask | disc).sum()
    refused(lambda: bimodal.suggest_mask(colours.astype(np.float32), marks), "type", "image.data")
    refused(lambda: bimodal.suggest_mask(colours.astype(np.uint8), marks + 1), "range", "marks")
    refused(lambda: bimodal.suggest_mask(colours.astype(np.uint8), marks[1:]), "size", "marks")
