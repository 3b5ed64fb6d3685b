"""Every reader of the project: a valid input, how it is made wrong, and how it is read."""

import json
import warnings
from functools import partial

import cv2
import numpy as np

from odometry.effects.tables import model_of
from odometry.errors import OdometryError
from odometry.estimation.terrain_beliefs import prior_belief
from odometry.installed import shipped_data
from odometry.io.tum import read_tum
from odometry.modes.follow.track import follow_modes
from odometry.modes.models.mode_set_file import read_mode_set, write_mode_set
from odometry.parameters import read_parameters
from odometry.recording.run import Run
from odometry.simulation.contact.vehicle import read_contact_vehicle
from odometry.tables.table import Table
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.run_inputs import inputs_of
from odometry.windows.travel.windows import windows_of
from terrain.camera.camera import Camera
from terrain.classification.classifier import TerrainClassifier
from terrain.classification.photographs.patches import find_photos, stated_metres_per_pixel
from terrain.cli.verbs.evaluate import _rows
from terrain.cli.verbs.pose_tables import read_pose_table
from terrain.config import Config
from terrain.images import read_image
from terrain.main_job import run_odometry
from terrain.results import read_errors
from terrain.synthesis.config import SynthesisConfig, read_camera, read_robot
from tests.fuzz.camera_readers import camera_readers
from tests.fuzz.mutations import bytes_changed, json_changed, model_changed, text_changed
from tests.fuzz.reader import reader_of
from tests.odometry.modes.mode_examples import traction_set, velocity_set

CAMERA = """[camera]
image_size = [160, 120]
matrix = [[120.0, 0.0, 80.0], [0.0, 118.0, 58.0], [0.0, 0.0, 1.0]]
distortion = [-0.12, 0.03, 0.001, -0.001]
mount = [0.2, 0.0, 0.55, 0.01, 0.85, 0.02]
"""
RUN = f"""[robot]
name = "fuzzed"
track_width = 0.5
length = 0.5
mass = 30
[run]
terrain = "grass"
[sensors]
pose = [0.1, 0.0, 0.5]
imu = [0.0, 0.1, 1.5]
{CAMERA}"""
SET = """[vehicle]
name = "fuzzed"
[terrain.grass]
y_left = 0.41
y_right = -0.39
x_icr = -0.02
[terrain.grass.sigma]
y_left = 0.02
x_icr = 0.01
[terrain.ice]
model = "icr_symmetric"
alpha = 0.9
b_hat = 0.8
[terrain.ice.covariance]
order = ["alpha", "b_hat"]
matrix = [[0.01, 0.001], [0.001, 0.02]]
[[terrain.grass.effects]]
name = "slope_sliding"
form = "icr_slope"
parameters = { lambda_1 = 1.2, lambda_2 = 5.0, v_max = 1.0, half_width = 0.6, half_length = 1.06 }
[[terrain.grass.effects]]
name = "unknown"
form = "residual"
variable = "speed"
terms = [["v_x", 0], ["omega", 1]]
knots = [0.0, 0.5, 1.0]
parameters = { v_x_0 = 0.01, omega_1 = 0.02 }
[[terrain.grass.effects]]
name = "wheel_scale"
form = "factors"
parameters = { c_l = 0.9, c_r = 1.1 }
"""
SETTINGS = """[filter]
position_sigma_m = 0.03
gate_patience = 5
detect_jumps = true
[region]
footprint_scale = 1.1
per_tread = false
[switch]
labels_in_row = 3
[evaluation]
horizon_m = 4
stride_m = 0.5
"""


def fails(reader, content):
    """None where it is read, else the error of the project; others and warnings are raised."""
    _put(reader.file, content)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            reader.read()
    except OdometryError as error:
        return error
    finally:
        _put(reader.file, reader.valid)
    return None


def _put(file, content):
    """In a new file: one that is cut to nothing first waits for the disk on some file systems."""
    file.unlink(missing_ok=True)
    file.write_bytes(content)


def readers(folder):
    """All readers, their files in `folder`."""
    return [
        *_of_runs(folder / "run"),
        *_of_settings(folder),
        *_of_images(folder),
        *camera_readers(folder),
        _of_classifier(folder / "terrain.model"),
        _of_manifest(folder / "patches"),
        _of_results(folder / "results"),
    ]


def _of_runs(folder):
    t = np.arange(8) * 0.1
    tables = {
        "odometry": ["t,v_left,v_right,roll,pitch,gyro_z,accel_x,terrain"]
        + [f"{s:.1f},0.{i}5,0.6{i},0.01,-0.02,0.{i},9.1,grass" for i, s in enumerate(t)],
        "pose": ["t,x,y,yaw,window"] + [f"{s:.1f},{s},0.1,0.{i},0" for i, s in enumerate(t)],
        "velocity": ["t,vx,vy,wz"] + [f"{s:.1f},0.5,,0.{i}" for i, s in enumerate(t)],
        "images": ["t,file,terrain"] + [f"{s:.1f},images/{i}.jpg,grass" for i, s in enumerate(t)],
        "truth": ["t,x,y,yaw,terrain"] + [f"{s:.1f},{s},0.1,0.{i},grass" for i, s in enumerate(t)],
        "imu": ["t,gyro_x,gyro_y,gyro_z"] + [f"{s:.1f},0.1,0,0.{i}" for i, s in enumerate(t)],
    }
    (folder / "images").mkdir(parents=True)
    for i in range(len(t)):
        (folder / "images" / f"{i}.jpg").touch()
    for name, rows in tables.items():
        text = "\n".join(rows) + "\n"
        yield reader_of(
            f"{name}.csv", folder / f"{name}.csv", text.encode(), text_changed, lambda: _use(folder)
        )
    yield from _of_fixes(folder)
    yield reader_of(
        "run.toml", folder / "run.toml", RUN.encode(), text_changed, lambda: _use(folder)
    )


def _of_fixes(folder):
    csv = [f"{100 * i},3,48.10000{i},11.5000{i},51{i}.5" for i in range(8)]
    pos = [f"2026/11/30 10:00:0{i}.000 48.10000{i} 11.5000{i} 51{i}.5 1 9" for i in range(8)]
    texts = {
        "gnss.csv": ["time_ms,fix_type,latitude,longitude,altitude", *csv],
        "gnss.pos": ["%  GPST latitude(deg) longitude(deg) height(m) Q ns", *pos],
        "gnss.nmea": [
            "$GPRMC,083559.00,A,4717.11437,N,00833.91522,E,0.004,77.52,091202,,,A*57",
            "$GPGGA,092725.00,4717.11399,N,00833.91590,E,1,08,1.01,499.6,M,48.0,M,,*5B",
        ],
    }
    for name, lines in texts.items():
        file = folder / name
        text = "\n".join(lines) + "\n"
        yield reader_of(name, file, text.encode(), text_changed, partial(_use_fixes, file))


def _use_fixes(file):
    odometry = Table(file, {"t": np.arange(8) * 0.1}, np.arange(8))
    table = read_pose_table("pose", file, {}, odometry)
    assert np.isfinite(np.stack([table.columns[name] for name in "txy"])).all()
    assert (np.diff(table.columns["t"]) > 0).all()


def _use(folder):
    """Read a run, cut it into windows and replay it."""
    run = Run.read(folder)
    assert run.yaw_rate is None or np.isfinite(run.yaw_rate.yaw_rate_rad_s).all()
    inputs_of(run)
    if "camera" in run.settings:
        Camera.from_table(run.settings["camera"]).ground_to_pixels([[1.0, 0.0]])
    try:
        windows_of([run], WindowConfig(horizon_m=0.1))
    finally:
        run_odometry(run)


def _of_settings(folder):
    run = Run.read(folder / "run")

    def use_set():
        given = read_parameters(folder / "set.toml")
        for name, table in given.terrains.items():
            model = model_of(table, run.robot, name)
            model.twist(model.pack(table.values), inputs_of(run))
            prior_belief(given, name, 0.4, 0.1, 0.05)

    yield reader_of("parameter set", folder / "set.toml", SET.encode(), text_changed, use_set)
    for kind, make in (("velocity", velocity_set), ("traction", traction_set)):
        file = folder / f"{kind}.toml"
        write_mode_set(file, make())
        yield reader_of(
            f"{kind} modes",
            file,
            file.read_bytes(),
            text_changed,
            lambda file=file: follow_modes(run, read_mode_set(file)),
        )
    file = folder / "config.toml"
    yield reader_of("config", file, SETTINGS.encode(), text_changed, lambda: Config.read(file))
    camera = folder / "camera.toml"
    yield reader_of("camera", camera, CAMERA.encode(), text_changed, lambda: read_camera(camera))
    vehicle, shipped = folder / "vehicle.toml", shipped_data() / "vehicles" / "husky_like.toml"

    def use_vehicle():
        read_contact_vehicle(vehicle)
        SynthesisConfig(robot=read_robot(vehicle))

    yield reader_of("vehicle", vehicle, shipped.read_bytes(), text_changed, use_vehicle)
    tum = folder / "a.tum"
    rows = "\n".join(f"{i} {i}.5 0 0 0 0 0.6 0.8" for i in range(5)) + "\n"
    yield reader_of("TUM", tum, rows.encode(), text_changed, lambda: read_tum(tum))


def _of_images(folder):
    pixels = np.random.default_rng(0).integers(0, 256, (9, 12, 3), np.uint8)
    for suffix in ("png", "jpg", "tiff", "bmp"):
        file = folder / f"photo.{suffix}"
        encoded = cv2.imencode(f".{suffix}", pixels)[1].tobytes()
        yield reader_of(
            f"image, {suffix}", file, encoded, bytes_changed, lambda file=file: read_image(file)
        )


def _of_classifier(file):
    rng = np.random.default_rng(0)
    images = [rng.integers(0, 60 + 60 * (i % 2), (16, 16), np.uint8) for i in range(12)]
    labels = ["grass", "sand"] * 6
    model = TerrainClassifier(preset="chen2023")
    model.fit(images, labels, [str(i // 2) for i in range(12)])
    model.save(file)

    def use():
        TerrainClassifier.load(file).classify(images[:1])

    return reader_of("classifier", file, file.read_bytes(), model_changed, use)


def _of_manifest(folder):
    for name in ("grass/a.jpg", "grass/b.jpg", "sand/c.png"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).touch()
    text = (
        "path,photo_id,metres_per_pixel\n"
        "grass/a.jpg,1,0.003\ngrass/b.jpg,1,0.003\nsand/c.png,2,0.003\n"
    )

    def use():
        find_photos(folder)
        stated_metres_per_pixel(folder)

    return reader_of("manifest.csv", folder / "manifest.csv", text.encode(), text_changed, use)


def _of_results(folder):
    errors = {
        "windows": 3,
        "translation_m_per_m": {"mean": 0.01, "quartiles": [0.01, 0.02, 0.03]},
        "rotation_deg_per_m": {"mean": 1.5, "quartiles": None},
        "position_m": {"mean": 0.25, "final": None},
    }
    content = {"reference": "pose", "horizon_m": 5.0, "errors": {"odometer": errors}}

    def use():
        for row in _rows("results", "run", read_errors(folder)):
            "".join(row).encode()

    text = json.dumps(content, indent=1).encode()
    return reader_of("result.json", folder / "result.json", text, json_changed, use)
