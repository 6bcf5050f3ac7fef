"""A world and the robot as one MuJoCo model."""
import mujoco
import numpy as np

from . import kobuki, textures

# Image of the depth camera, px, and its focal length, px: 512 x 424 at 70.1 x 60.3 deg, as a Kinect V2.
WIDTH_PX, HEIGHT_PX, FOCAL_PX = 512, 424, 365.0
# Physics step, s.
STEP_S = 0.002


def model(world, seed):
    """The compiled model. A solid box has a geometry for contacts and a textured mesh to be seen."""
    rng = np.random.default_rng(3000 + seed)
    assets, parts, drawn, solid = {}, [], [], []
    for number, box in enumerate(world.boxes):
        name = texture(box, number, rng, assets, parts)
        parts.append(mesh(box, number))
        placed = f'pos="{vector(box.centre)}" euler="0 0 {box.yaw}"'
        drawn.append(f'<geom type="mesh" mesh="m{number}" material="{name}" {placed} contype="0" conaffinity="0" group="0"/>')
        if box.solid:
            half = vector(np.array(box.size) / 2)
            solid.append(f'<geom name="solid{number}" type="box" size="{half}" {placed} group="4" contype="1" conaffinity="2"/>')
    fovy = 2 * np.degrees(np.arctan(HEIGHT_PX / 2 / FOCAL_PX))
    text = f"""
<mujoco>
  <compiler angle="radian" autolimits="true"/>
  <option timestep="{STEP_S}" cone="elliptic" impratio="10" integrator="implicitfast"/>
  <visual>
    <headlight ambient="0.5 0.5 0.5" diffuse="0 0 0" specular="0 0 0"/>
    <map znear="0.002" zfar="1"/>
    <quality shadowsize="0" offsamples="0"/>
    <global offwidth="{WIDTH_PX}" offheight="{HEIGHT_PX}"/>
  </visual>
  <statistic extent="12" center="4 3 1"/>
  <asset>{"".join(parts)}</asset>
  <worldbody>
    <light directional="true" castshadow="false" dir="0.5 0.35 -0.8" diffuse="0.35 0.35 0.33" specular="0 0 0"/>
    <light directional="true" castshadow="false" dir="-0.45 -0.6 0.4" diffuse="0.25 0.25 0.28" specular="0 0 0"/>
    <geom name="floor" type="plane" size="20 20 0.1" group="4" friction="1 0.001 0.0001" contype="8" conaffinity="4"/>
    {"".join(drawn)}{"".join(solid)}
    {kobuki.xml(world.start, fovy)}
  </worldbody>
  <actuator>{kobuki.actuators()}</actuator>
</mujoco>"""
    return mujoco.MjModel.from_xml_string(text, assets)


def vector(values):
    return " ".join(f"{v:.5f}" for v in values)


def texture(box, number, rng, assets, parts):
    """Name of the material; one texture a poster and a piece of furniture, one for all floors and ceilings of a kind."""
    name = f"{box.kind}{number}"
    file = f"{name}.png"
    assets[file] = textures.encode(textures.KINDS[box.kind](rng))
    parts.append(f'<texture name="{name}" type="2d" file="{file}"/>')
    parts.append(f'<material name="{name}" texture="{name}" specular="0" shininess="0" reflectance="0"/>')
    return name


def mesh(box, number):
    """A cuboid of 24 vertices with texture coordinates: a poster fills its face, other textures have one scale."""
    sx, sy, sz = box.size
    vertices, coordinates, faces = [], [], []
    for axis in range(3):
        u, v = ((1, 2), (0, 2), (0, 1))[axis]
        for side in (-1, 1):
            first = len(vertices)
            for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                corner = [0.0, 0.0, 0.0]
                corner[axis], corner[u], corner[v] = side * box.size[axis] / 2, a * box.size[u] / 2, b * box.size[v] / 2
                vertices.append(corner)
                scale = (1, 1) if box.kind == "poster" else (box.size[u] / textures.TILE_M, box.size[v] / textures.TILE_M)
                coordinates.append(((a + 1) / 2 * scale[0], (1 - b) / 2 * scale[1]))
            outward = (side > 0) == (axis != 1)
            faces += [(0, 1, 2), (0, 2, 3)] if outward else [(0, 2, 1), (0, 3, 2)]
            faces[-2:] = [tuple(first + i for i in f) for f in faces[-2:]]
    return (f'<mesh name="m{number}" inertia="shell" vertex="{" ".join(map(vector, vertices))}" '
            f'texcoord="{" ".join(map(vector, coordinates))}" face="{" ".join(f"{a} {b} {c}" for a, b, c in faces)}"/>')
