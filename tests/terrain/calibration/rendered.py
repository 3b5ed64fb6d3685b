"""Chessboards and marked points as a true camera sees them: rays cast here, none of the packages.

A camera is a table as in run.toml: image_size, matrix, distortion (k1, k2, p1, p2[, k3]), mount.
"""

import cv2
import numpy as np

OVERSAMPLING = 3  # along each side of a pixel
OPTICAL = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])  # columns: x right ...


def rotation(roll, pitch, yaw):
    """R = Rz(yaw) Ry(pitch) Rx(roll), by Rodrigues' formula."""
    about = [[0, 0, yaw], [0, pitch, 0], [roll, 0, 0]]
    rz, ry, rx = (cv2.Rodrigues(np.array(vector, float))[0] for vector in about)
    return rz @ ry @ rx


def bend(x, y, lens):
    """OpenCV's plumb bob: k1, k2, p1, p2, k3 of undistorted x and y."""
    k1, k2, p1, p2, k3 = np.pad(np.asarray(lens, float), (0, 5 - len(lens)))
    r2 = x * x + y * y
    radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
    return (
        x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
        y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
    )


def unbend(bent_x, bent_y, lens):
    """Undo the lens by fixed-point iteration."""
    x, y = bent_x, bent_y
    for _ in range(80):
        again_x, again_y = bend(x, y, lens)
        x, y = x + bent_x - again_x, y + bent_y - again_y
    return x, y


def project(camera, points):
    """Pixels (N, 2) of robot-frame points (N, 3)."""
    mount = np.array(camera["mount"], float)
    seen = (points - mount[:3]) @ rotation(*mount[3:]) @ OPTICAL
    x, y = bend(seen[:, 0] / seen[:, 2], seen[:, 1] / seen[:, 2], camera["distortion"])
    (fx, _, cx), (_, fy, cy), _ = camera["matrix"]
    return np.column_stack([fx * x + cx, fy * y + cy])


def ground_behind(camera, pixels):
    """Points (N, 2) of the terrain behind pixels (N, 2), NaN above the horizon."""
    (fx, _, cx), (_, fy, cy), _ = camera["matrix"]
    u, v = np.asarray(pixels, float).T
    x, y = unbend((u - cx) / fx, (v - cy) / fy, camera["distortion"])
    mount = np.array(camera["mount"], float)
    rays = np.stack([x, y, np.ones_like(x)], axis=-1) @ OPTICAL.T @ rotation(*mount[3:]).T
    down = np.where(rays[:, 2] < -1e-9, -rays[:, 2], np.nan)
    return mount[:2] + rays[:, :2] * (mount[2] / down)[:, None]


def marked(camera, ground, noise_px=0.0, rng=None):
    """Rows u, v, x, y of points (N, 2) of the terrain that the image shows."""
    pixels = project(camera, np.column_stack([ground, np.zeros(len(ground))]))
    if noise_px:
        pixels = pixels + rng.normal(0, noise_px, pixels.shape)
    inside = ((pixels >= 0) & (pixels <= np.array(camera["image_size"]) - 1)).all(axis=1)
    return np.column_stack([pixels, ground])[inside]


def optical_rays(camera):
    """Undistorted x and y (H n, W n) of the rays through the parts of pixels."""
    width, height = camera["image_size"]
    offset = (np.arange(OVERSAMPLING) + 0.5) / OVERSAMPLING - 0.5
    u = (np.arange(width)[:, None] + offset).ravel()
    v = (np.arange(height)[:, None] + offset).ravel()
    u, v = np.meshgrid(u, v)
    (fx, _, cx), (_, fy, cy), _ = camera["matrix"]
    return unbend((u - cx) / fx, (v - cy) / fy, camera["distortion"])


def board_photo(rays, pose, inner, square_m, rng):
    """Grey photograph of a board of squares, one more along each side than inner corners.

    A pose is the board's axes as columns (3, 3) and its middle (3,), in the optical frame. A white
    rim of one square surrounds it, grey wall is behind.
    """
    turn, middle = pose
    x, y = rays
    direction = np.stack([x, y, np.ones_like(x)], axis=-1)
    depth = (turn[:, 2] @ middle) / (direction @ turn[:, 2])
    on_board = (direction * depth[..., None] - middle) @ turn[:, :2] / square_m
    sides = np.array(inner) + 1
    cell = np.floor(on_board + sides / 2)
    white = (cell.sum(axis=-1) % 2 == 0) * 180.0 + 30.0
    in_squares = ((cell >= 0) & (cell < sides)).all(axis=-1)
    in_rim = (np.abs(on_board) < sides / 2 + 1).all(axis=-1) & (depth > 0)
    fine = np.where(in_squares, white, 225.0)
    fine = np.where(in_rim, fine, 110.0)
    n = OVERSAMPLING
    image = fine.reshape(fine.shape[0] // n, n, fine.shape[1] // n, n).mean(axis=(1, 3))
    return np.clip(np.rint(image + rng.normal(0, 2.0, image.shape)), 0, 255).astype(np.uint8)


def board_poses(camera, count, inner, square_m, rng):
    """Turns and middles of boards that the image shows whole, tilted by up to 45 degrees."""
    width, height = camera["image_size"]
    (fx, _, cx), (_, fy, cy), _ = camera["matrix"]
    poses = []
    while len(poses) < count:
        tilt = rng.uniform(-0.8, 0.8, 2)
        spin = rotation(0, 0, rng.uniform(-0.5, 0.5))
        turn = rotation(0, tilt[0], 0) @ rotation(tilt[1], 0, 0) @ spin
        distance = rng.uniform(0.7, 1.6) * fx * square_m * (inner[0] + 3) / width * 1.3
        aim = np.array([rng.uniform(0.1, 0.9) * width, rng.uniform(0.1, 0.9) * height])
        middle = np.array([(aim[0] - cx) / fx, (aim[1] - cy) / fy, 1.0]) * distance
        half = (np.array(inner) + 2.2) / 2 * square_m
        corners = np.array([[a, b, 0] for a in (-half[0], half[0]) for b in (-half[1], half[1])])
        seen = corners @ turn.T + middle
        if (seen[:, 2] < 0.2 * distance).any():
            continue
        x, y = bend(seen[:, 0] / seen[:, 2], seen[:, 1] / seen[:, 2], camera["distortion"])
        u, v = fx * x + cx, fy * y + cy
        if min(u.min(), v.min()) > 2 and u.max() < width - 3 and v.max() < height - 3:
            poses.append((turn, middle))
    return poses
