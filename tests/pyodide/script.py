"""The calls of a notebook in the browser: a rendered scene, a run of few steps, a part of the method, a check, and
errors."""

import bimodal_stereo as bimodal

scene = bimodal.sample("bust", "colourful", size=48, angles={"beta": 20}, noise=0.01)
assert scene.image.data.shape == (48, 48, 3) and scene.light.shape == (3, 9)
estimator = bimodal.Estimator(scene.image, scene.depth, start="identity", stop_degrees=0.01)
seen = []
report = estimator.run(on_step=lambda report: seen.append(report.stage))
print("run", report.status, report.pose.angles.beta, len(seen))
assert estimator.image_normals().shape == (48, 48, 3) and estimator.points("depth").shape[1] == 3
assert estimator.correspondence().dtype.name == "int32"
assert estimator.save().startswith(b"bimodal-stereo")

print("light", bimodal.turn_light("window", {"beta": 30}).shape, "lights", len(bimodal.sample_lights()))

rig = bimodal.sample_rig("room", seed=1)
told = []
check = bimodal.check_calibration([bimodal.CheckFrame(rig.image, rig.depth)], {"new": vars(rig.pose)}, on_progress=lambda *each: told.append(each))
print("check", check.verdict, list(check.candidates), len(told) > 3)

for call in (
    lambda: bimodal.Estimator(scene.image, scene.depth, stop_degrees=-1),
    lambda: bimodal.sample("teapot", "window"),
    lambda: bimodal.read_image("image.png"),
    lambda: bimodal.Estimator(scene.image, scene.depth, no_such_option=1),
):
    try:
        call()
        print("refused", "nothing")
    except bimodal.BimodalError as error:
        print("refused", error.code, error.field, str(error).startswith(error.field))
