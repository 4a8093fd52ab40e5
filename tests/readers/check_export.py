"""Reads what `sunfleck export` wrote with programs that are not ours, and compares every number with the result file.

    check_export.py RESULT.h5 FILE...

A reader that is not installed is skipped with a line that says so. Exit code 1 if anything differs. Formats and readers:
.vtkhdf VTK and h5py; .ply VTK and numpy; .obj VTK and meshio; .xdmf h5py along every reference, and VTK too where it was
built with its XDMF reader (PyPI's and ParaView's are, Debian's python3-vtk9 is not);
.glb VTK, and json with struct; .csv (of organs, groups, sensors) the csv module; .opf the xml module. An .opf must be of the copy
that its name tells: shrub_1.opf is shrub[1].
"""
import csv
import json
import struct
import sys
import xml.etree.ElementTree as xml
from importlib.util import find_spec
from pathlib import Path

import h5py
import numpy as np


class Expected:
    """Facets as the result file describes them, expanded here from its meshes and maps (docs/formats-result.md)."""

    def __init__(self, path):
        self.file = f = h5py.File(path)
        g = f["geometry"]
        vertices, triangles = g["vertices"][:], g["triangles"][:].astype(np.int64)
        first_vertex, first_triangle = g["mesh_first_vertex"][:], g["mesh_first_triangle"][:]
        corners = []
        for plant, copy in zip(g["copy_plant"][:], g["copy_map"][:]):
            model = g["plant_model"][plant]
            for s in range(int(g["model_first_shape"][model]), int(g["model_first_shape"][model + 1])):
                mesh, place = g["shape_mesh"][s], g["shape_placement"][s]
                t = int(first_triangle[mesh]) + int(g["shape_first_triangle"][s])
                rows = triangles[t:t + int(g["shape_triangle_count"][s])] + int(first_vertex[mesh])
                p = vertices[rows] @ place[:, :3].T + place[:, 3]
                p = p @ copy[:, :3].T + copy[:, 3]
                if np.linalg.det(copy[:, :3]) * np.linalg.det(place[:, :3]) < 0:
                    p = p[:, [0, 2, 1]]
                corners.append(p)
        if g.attrs["ground_facets"] > 0:
            corners.append(vertices[int(first_vertex[-2]) + triangles[int(first_triangle[-2]):int(first_triangle[-1])]])
        self.corners = np.concatenate(corners)
        self.bands = [b.decode() for b in f["bands/name"][:]]
        self.states = [s.decode() for s in f["states/name"][:]]
        self.organ = f["facets/organ"][:]
        self.area = f["facets/area"][:]

    def columns(self):
        """name -> values of every facet, as .ply and .vtkhdf name them."""
        out = {}
        for s, state in enumerate(self.states):
            suffix = "_" + state.replace(" ", "_") if len(self.states) > 1 else ""
            for b, band in enumerate(self.bands):
                out[f"irradiance_front_{band}{suffix}"] = self.file["facets/irradiance"][s, :, 0, b]
                out[f"irradiance_back_{band}{suffix}"] = self.file["facets/irradiance"][s, :, 1, b]
                out[f"absorbed_{band}{suffix}"] = self.file["facets/absorbed"][s, :, b]
            out[f"sunlit_front{suffix}"] = self.file["facets/sunlit"][s, :, 0]
            out[f"sunlit_back{suffix}"] = self.file["facets/sunlit"][s, :, 1]
        return out


failures = []


def check(what, good):
    if not good:
        failures.append(what)
        print("DIFFERS:", what)


def same(what, found, expected):
    check(what, np.shape(found) == np.shape(expected) and np.array_equal(np.asarray(found), np.asarray(expected)))


def close(what, found, expected, tolerance):
    good = np.shape(found) == np.shape(expected) and (np.size(found) == 0 or np.abs(found - expected).max() <= tolerance)
    check(what, good)


def module(name):
    try:
        return __import__(name, fromlist=["*"])
    except ImportError:
        print(f"skipped: python module {name} is not installed")
        return None


def vtk_grid(reader):
    reader.Update()
    return vtk_arrays(reader.GetOutput())


def vtk_arrays(data):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    cells = data.GetCells() if hasattr(data, "GetCells") else data.GetPolys()
    if data.IsA("vtkPolyData"):
        cells = data.GetPolys()
    points = vtk_to_numpy(data.GetPoints().GetData())
    corners = points[vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, 3)]
    arrays = lambda d: {d.GetArrayName(i): vtk_to_numpy(d.GetArray(i)) for i in range(d.GetNumberOfArrays())}
    return corners, arrays(data.GetCellData()), arrays(data.GetPointData())


# Roundings of one affine map, relative to the size of the scene.
def exact(e):
    return 1e-14 * (1 + np.abs(e.corners).max())


def single(e):
    return 4e-7 * (1 + np.abs(e.corners).max())


def read_vtkhdf(e, path):
    if module("vtkmodules.vtkIOHDF"):
        from vtkmodules.vtkIOHDF import vtkHDFReader
        reader = vtkHDFReader()
        reader.SetFileName(path)
        corners, cells, _ = vtk_grid(reader)
        close(".vtkhdf corners (VTK)", corners, e.corners, exact(e))
        for name, values in e.columns().items():
            same(f".vtkhdf {name} (VTK)", cells.get(name), values)
        same(".vtkhdf organ (VTK)", cells.get("organ"), e.organ)
        same(".vtkhdf area (VTK)", cells.get("area"), e.area)
        check(".vtkhdf colour (VTK)", cells["colour"].shape == (len(e.area), 3) and cells["colour"].dtype == np.uint8)
        print("read by VTK:", path)
    with h5py.File(path) as f:
        root = f["VTKHDF"]
        check(".vtkhdf header", bytes(root.attrs["Type"]) == b"UnstructuredGrid" and list(root.attrs["Version"]) == [1, 0])
        close(".vtkhdf corners (h5py)", root["Points"][:][root["Connectivity"][:].reshape(-1, 3)], e.corners, exact(e))
    print("read by h5py:", path)


def read_ply(e, path):
    with open(path, "rb") as f:
        fields, counts, element = {"vertex": [], "face": []}, {}, None
        while (words := f.readline().decode().split())[0] != "end_header":
            if words[0] == "element":
                element, counts[words[1]] = words[1], int(words[2])
            elif words[0] == "property" and words[1] == "list":
                fields["face"] += [("corners_of_face", "u1"), ("corners", "<i4", 3)]
            elif words[0] == "property":
                fields[element].append((words[2], {"double": "<f8", "float": "<f4", "int": "<i4", "uchar": "u1"}[words[1]]))
        vertices = np.fromfile(f, fields["vertex"], counts["vertex"])
        faces = np.fromfile(f, fields["face"], counts["face"])
        check(".ply size", not f.read(1))
    points = np.stack([vertices[k] for k in "xyz"], 1)
    close(".ply corners (numpy)", points[faces["corners"]], e.corners, exact(e))
    for name, values in e.columns().items():
        same(f".ply {name} (numpy)", faces[name], values)
    same(".ply organ (numpy)", faces["organ"].astype(np.uint32), e.organ)
    same(".ply area (numpy)", faces["area"], e.area)
    print("read by numpy:", path)
    if module("vtkmodules.vtkIOPLY"):
        from vtkmodules.vtkIOPLY import vtkPLYReader
        reader = vtkPLYReader()
        reader.SetFileName(path)
        corners, cells, _ = vtk_grid(reader)
        close(".ply corners (VTK)", corners, e.corners, single(e))
        check(".ply colours (VTK)", cells["RGB"].shape == (len(e.area), 3))
        print("read by VTK:", path)


def read_obj(e, path):
    if module("vtkmodules.vtkIOGeometry"):
        from vtkmodules.vtkIOGeometry import vtkOBJReader
        reader = vtkOBJReader()
        reader.SetFileName(path)
        corners, _, _ = vtk_grid(reader)
        close(".obj corners (VTK)", corners, e.corners, single(e))
        print("read by VTK:", path)
    if module("meshio"):
        import meshio
        mesh = meshio.read(path)
        points = np.asarray(mesh.points)[:, :3]
        cells = np.concatenate([c.data for c in mesh.cells])
        close(".obj corners (meshio)", points[cells], e.corners, exact(e))
        print("read by meshio:", path)
    groups, rgb = [], []
    group = None
    for line in open(path):
        word, *rest = line.split()
        if word == "g":
            group = int(rest[0].removeprefix("organ_"))
        elif word == "f":
            groups.append(group)
        elif word == "v":
            rgb.append([float(x) for x in rest[3:]])
    same(".obj groups", np.array(groups, dtype=np.uint32), e.organ)
    rgb = np.array(rgb)
    check(".obj colours", rgb.shape[1] == 3 and rgb.min() >= 0 and rgb.max() <= 1)


def read_xdmf(e, path):
    folder = Path(path).parent
    tree = xml.parse(path)
    item = lambda node: hyperslab(folder, node)
    grids = [g for g in tree.iter("Grid") if g.get("GridType") == "Uniform"]
    per_state = len(grids) // len(e.states)
    check(".xdmf one grid a state", len(grids) % len(e.states) == 0)
    for s in range(len(e.states)):
        corners, found = [], {}
        for grid in grids[s * per_state:(s + 1) * per_state]:
            corners.append(item(grid.find("Geometry/DataItem"))[item(grid.find("Topology/DataItem"))])
            for attribute in grid.iter("Attribute"):
                found.setdefault(attribute.get("Name"), []).append(item(attribute.find("DataItem")))
        close(".xdmf corners", np.concatenate(corners), e.corners, exact(e))
        suffix = "_" + e.states[s].replace(" ", "_") if len(e.states) > 1 else ""
        for name, values in e.columns().items():
            if name.endswith(suffix):
                same(f".xdmf {name}", np.concatenate(found[name.removesuffix(suffix) if suffix else name]), values)
        same(".xdmf organ", np.concatenate(found["organ"]), e.organ)
        check(".xdmf colour", np.concatenate(found["colour"]).shape == (len(e.area), 3))
    print("read by h5py:", path)
    if find_spec("vtkmodules") and find_spec("vtkmodules.vtkIOXdmf2"):
        from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
        from vtkmodules.vtkFiltersCore import vtkAppendFilter
        reader = vtkXdmfReader()
        reader.SetFileName(path)
        reader.UpdateInformation()
        times = [float(t) for t in vtk_times(reader)]
        check(".xdmf time steps (VTK)", times == ([float(s) for s in range(len(e.states))] if len(e.states) > 1 else []))
        for s, state in enumerate(e.states):
            reader.UpdateTimeStep(s) if times else reader.Update()
            data = reader.GetOutputDataObject(0)
            if data.IsA("vtkCompositeDataSet"):
                append = vtkAppendFilter()
                for i in range(data.GetNumberOfBlocks()):
                    append.AddInputData(data.GetBlock(i))
                append.Update()
                data = append.GetOutput()
            corners, cells, _ = vtk_arrays(data)
            close(".xdmf corners (VTK)", corners, e.corners, exact(e))
            suffix = "_" + state.replace(" ", "_") if len(e.states) > 1 else ""
            for name, values in e.columns().items():
                if name.endswith(suffix):
                    same(f".xdmf {name} (VTK)", cells[name.removesuffix(suffix) if suffix else name], values)
        print("read by VTK:", path)


def vtk_times(reader):
    information = reader.GetOutputInformation(0)
    return information.Get(reader.GetExecutive().TIME_STEPS()) or [] if information.Has(reader.GetExecutive().TIME_STEPS()) else []


def hyperslab(folder, node):
    if node.get("ItemType") != "HyperSlab":
        name, dataset = node.text.strip().rsplit(":", 1)
        with h5py.File(folder / name) as f:
            values = f[dataset][()]
        check(f"{path_of(node)} has the dimensions it says", list(values.shape) == [int(d) for d in node.get("Dimensions").split()])
        return values
    slab, data = node.findall("DataItem")
    rows = np.array(slab.text.split(), dtype=int).reshape(3, -1)
    values = hyperslab(folder, data)
    picked = values[tuple(slice(a, a + n * k, k) for a, k, n in rows.T)]
    return picked.reshape([int(d) for d in node.get("Dimensions").split()])


def path_of(node):
    return node.text.strip()


def read_glb(e, path):
    raw = Path(path).read_bytes()
    magic, version, length, json_length, kind = struct.unpack("<4sIII4s", raw[:20])
    check(".glb header", magic == b"glTF" and version == 2 and length == len(raw) and kind == b"JSON" and json_length % 4 == 0)
    gltf = json.loads(raw[20:20 + json_length])
    bin_length, kind = struct.unpack("<I4s", raw[20 + json_length:28 + json_length])
    data = raw[28 + json_length:]
    check(".glb buffer", kind == b"BIN\0" and bin_length == len(data) == gltf["buffers"][0]["byteLength"])

    def values(row):
        a = gltf["accessors"][row]
        v = gltf["bufferViews"][a["bufferView"]]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[a["type"]]
        dtype = np.dtype({5126: "<f4", 5123: "<u2", 5125: "<u4"}[a["componentType"]])
        step = v.get("byteStride", width * dtype.itemsize)
        return np.ndarray((a["count"], width), dtype, data, v["byteOffset"] + a["byteOffset"], (step, dtype.itemsize))

    root = gltf["nodes"][0]
    centre = np.array(root["translation"])
    centre = np.array([centre[0], -centre[2], centre[1]])
    facets = []
    for child in root["children"]:
        node = gltf["nodes"][child]
        primitive = gltf["meshes"][node["mesh"]]["primitives"][0]
        position = values(primitive["attributes"]["POSITION"])
        accessor = gltf["accessors"][primitive["attributes"]["POSITION"]]
        same(".glb bounds", np.array([accessor["min"], accessor["max"]], "f4"), np.array([position.min(0), position.max(0)]))
        triangles = values(primitive["indices"]).reshape(-1, 3)
        places = node.get("extensions", {}).get("EXT_mesh_gpu_instancing", {}).get("attributes")
        if not places:
            facets.append(position[triangles] + centre)
            continue
        for t, q, s in zip(*(values(places[k]).astype(float) for k in ("TRANSLATION", "ROTATION", "SCALE"))):
            p = position.astype(float) * s
            p = p + 2 * np.cross(q[:3], np.cross(q[:3], p) + q[3] * p)
            c = (p + t + centre)[triangles]
            facets.append(c[:, [0, 2, 1]] if np.prod(s) < 0 else c)
    found = np.concatenate(facets)
    check(".glb number of facets", len(found) == len(e.corners))
    if len(found) == len(e.corners):
        tolerance = 1e-6 * (1 + np.abs(e.corners - centre).max())
        if any("extensions" in gltf["nodes"][child] for child in root["children"]):  # copies that share a mesh come first
            close(".glb centroids", nearest(found.mean(1), e.corners.mean(1)), np.zeros(len(found)), tolerance)
            close(".glb centroids, all of them", nearest(e.corners.mean(1), found.mean(1)), np.zeros(len(found)), tolerance)
        else:
            close(".glb corners", found, e.corners, tolerance)
        area = lambda c: np.linalg.norm(np.cross(c[:, 1] - c[:, 0], c[:, 2] - c[:, 0]), axis=1).sum() / 2
        close(".glb area", area(found), area(e.corners), 1e-5 * area(e.corners))
    print("read by json and struct:", path)
    if module("vtkmodules.vtkIOGeometry") and "extensionsRequired" not in gltf:
        from vtkmodules.vtkIOGeometry import vtkGLTFReader
        reader = vtkGLTFReader()
        reader.SetFileName(path)
        reader.Update()
        cells = colours = 0
        todo = [reader.GetOutput()]
        while todo:
            block = todo.pop()
            if block is None:
                continue
            if block.IsA("vtkMultiBlockDataSet"):
                todo.extend(block.GetBlock(i) for i in range(block.GetNumberOfBlocks()))
                continue
            cells += block.GetNumberOfCells()
            colours += block.GetPointData().GetArray("COLOR_0") is not None
        check(".glb cells (VTK)", cells == len(e.area) and colours > 0)
        print("read by VTK:", path)


def numbers(rows, name):
    return np.array([float(r[name]) if r[name] else np.nan for r in rows])


def organ_columns(e):
    """name -> values of every organ, as tables name them."""
    out = {"area_m2": e.file["organs/area"][:]}
    energy = [0.0] * len(e.bands)
    photons = ["mol" in unit for unit in e.file["bands/unit"].asstr()[:]]
    for s, state in enumerate(e.states):
        suffix = "_" + state if len(e.states) > 1 else ""
        for b, band in enumerate(e.bands):
            out[f"absorbed_{'umol_s' if photons[b] else 'W'}_{band}{suffix}"] = power = e.file["organs/absorbed"][s, :, b]
            energy[b] = energy[b] + power.astype(float) * e.file["states/duration"][s]
            for side, name in enumerate(("front", "back")):
                out[f"irradiance_{name}_{band}{suffix}"] = e.file["organs/irradiance"][s, :, side, b]
        for side, name in enumerate(("front", "back")):
            out[f"sunlit_{name}{suffix}"] = e.file["organs/sunlit"][s, :, side]
    if (e.file["states/duration"][:] > 0).all():
        for b, band in enumerate(e.bands):
            out[f"absorbed_{'umol' if photons[b] else 'J'}_{band}"] = energy[b].astype(np.float32)
    return out


def texts_of(e, name):
    return np.array(list(e.file[f"names/{name}"].asstr()))[e.file[f"organs/{name if name != 'organ' else 'name'}"][:]]


def read_csv(e, path):
    with open(path, newline="") as file:
        table = csv.DictReader(file)
        rows = list(table)
    if table.fieldnames[0] == "organ":
        return read_organs(e, path, table.fieldnames, rows)
    return read_sensors(e, path, table.fieldnames, rows) if table.fieldnames[0] == "sensor" else read_groups(e, path, table.fieldnames, rows)


def read_organs(e, path, names, rows):
    expected = organ_columns(e)
    same(f"{path}: columns", names, ["organ", "plant", "placement", "name", "type"] + list(expected))
    same(f"{path}: organs", numbers(rows, "organ"), np.arange(len(e.file["organs/area"])))
    for name, of in (("plant", "plant"), ("placement", "placement"), ("name", "organ"), ("type", "type")):
        same(f"{path}: {name}", [r[name] for r in rows], list(texts_of(e, of)))
    for name, values in expected.items():  # every digit of a float is written
        same(f"{path}: {name}", numbers(rows, name).astype(np.float32), values.astype(np.float32))


def read_groups(e, path, names, rows):
    keys = names[:names.index("organs")]
    group = list(zip(*(texts_of(e, key) for key in keys)))
    expected, area = organ_columns(e), e.file["organs/area"][:].astype(float)
    same(f"{path}: groups", sorted(tuple(r[k] for k in keys) for r in rows), sorted(set(group)))
    for r in rows:
        here = np.array([g == tuple(r[k] for k in keys) for g in group])
        check(f"{path}: organs of {r}", int(r["organs"]) == here.sum())
        for name, values in expected.items():
            of = values[here].astype(float)
            summed = name == "area_m2" or name.startswith("absorbed")
            wanted = of.sum() if summed else (of * area[here]).sum() / area[here].sum()
            check(f"{path}: {name} of {r}", abs(float(r[name]) - wanted) <= 1e-6 * abs(wanted))  # written as float32


def read_sensors(e, path, names, rows):
    begin = 0
    for name in e.file["names/sensor"].asstr()[:]:
        g = e.file[f"sensors/{name}"]
        here = rows[begin:begin + len(g["area"])]
        begin += len(here)
        same(f"{path}: {name}", [r["sensor"] for r in here], [name] * len(g["area"]))
        for axis in range(3):
            same(f"{path}: {name} {'xyz'[axis]}", numbers(here, "xyz"[axis]), g["centroid"][:, axis])
            same(f"{path}: {name} normal", numbers(here, "normal_" + "xyz"[axis]), g["normal"][:, axis])
        for s, state in enumerate(e.states):
            suffix = "_" + state if len(e.states) > 1 else ""
            for b, band in enumerate(e.bands):
                for column in ("irradiance", "standard_error", "irradiance_back", "standard_error_back"):
                    if column in g:
                        same(f"{path}: {name} {column}", numbers(here, f"{column}_{band}{suffix}").astype(np.float32), g[column][s, :, b])
    check(f"{path}: rows", begin == len(rows))


def read_opf(e, path):
    placement = "{}[{}]".format(*Path(path).stem.rsplit("_", 1))
    here = texts_of(e, "placement") == placement
    organs = [node for node in xml.parse(path).getroot().iter() if node.find("area_m2") is not None]
    check(f"{path}: organs", len(organs) == here.sum() > 0)
    for name, values in organ_columns(e).items():
        name = name.replace(" ", "_")
        same(f"{path}: {name}", np.array([float(node.find(name).text) for node in organs], np.float32), values[here].astype(np.float32))


def nearest(points, others):
    """Distance of every point to the nearest of the others."""
    return np.array([np.sqrt(((others - p)**2).sum(1).min()) for p in points])


def main():
    expected = Expected(sys.argv[1])
    for path in sys.argv[2:]:
        {".vtkhdf": read_vtkhdf, ".ply": read_ply, ".obj": read_obj, ".xdmf": read_xdmf, ".glb": read_glb,
         ".csv": read_csv, ".opf": read_opf}[Path(path).suffix](expected, path)
    print("all equal" if not failures else f"{len(failures)} differences")
    sys.exit(1 if failures else 0)


main()
