"""Small right files of each kind, from which the fuzz targets begin; by code, so that no binary lies in the tree."""
import base64
import gzip
import json
import struct
import zlib

POINTS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 0.5, 1)]
FACES = [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (3, 2, 1, 0)]


def floats(points, order="<"):
    return b"".join(struct.pack(order + "3f", *p) for p in points)


def ply():
    head = "ply\nformat {} 1.0\ncomment shift 1 2 3\ncomment material 0 water\nelement vertex 5\n"
    xyz = "property float x\nproperty float y\nproperty float z\n"
    faces = "element face 5\nproperty list uchar int vertex_indices\nend_header\n"
    text = head.format("ascii") + xyz + faces
    text += "".join("{} {} {}\n".format(*p) for p in POINTS)
    text += "".join(" ".join(map(str, (len(f), *f))) + "\n" for f in FACES)
    yield text.encode()
    for name, order in (("binary_little_endian", "<"), ("binary_big_endian", ">")):
        body = b"".join(struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in FACES)
        yield (head.format(name) + xyz + faces).encode() + floats(POINTS, order) + body
    more = "".join(f"property float v{a}\n" for a in "xyz") + "property int id\nproperty uchar material\n"
    more += "".join(f"property uchar {c}\n" for c in ("red", "green", "blue", "alpha"))
    rows = b"".join(struct.pack("<6fi5B", *p, 0, 0, 1, i, 0, 255, 0, 0, 9) for i, p in enumerate(POINTS))
    particles = (head.format("binary_little_endian") + xyz + more + "end_header\n").encode() + rows
    yield particles
    yield gzip.compress(particles)
    strips = "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
    yield (head.format("ascii") + xyz + strips + "0 0 0 " * 5 + "6 0 1 2 -1 3 4\n").encode()


def stl():
    corners = [p for f in FACES for p in (POINTS[i] for i in f[:3])]
    text = "solid a\n"
    for at in range(0, len(corners), 3):
        text += "facet normal 0 0 1\nouter loop\n"
        text += "".join("vertex {} {} {}\n".format(*p) for p in corners[at:at + 3]) + "endloop\nendfacet\n"
    yield (text + "endsolid a\n").encode()
    body = b"".join(bytes(12) + floats(corners[at:at + 3]) + bytes(2) for at in range(0, len(corners), 3))
    yield b"solid or not".ljust(80) + struct.pack("<I", len(corners) // 3) + body


def obj():
    vertices = "".join("v {} {} {}\n".format(*p) for p in POINTS)
    yield ("# a\n" + vertices + "".join("f " + " ".join(str(i + 1) for i in f) + "\n" for f in FACES)).encode()
    yield (vertices + "vn 0 0 1\nvt 0 1\nf -1/1/1 -2//1 \\\n -3/1\nf 1 2 5 3 4\n").encode()


def off():
    text = "OFF\n5 5 8\n" + "".join("{} {} {}\n".format(*p) for p in POINTS)
    yield (text + "".join(" ".join(map(str, (len(f), *f))) + "\n" for f in FACES)).encode()


def bgeo():
    def attribute(name, size, kind):
        return struct.pack(">H", len(name)) + name + struct.pack(">Hi", size, kind) + bytes(4 * size)
    kinds = attribute(b"v", 3, 5) + attribute(b"id", 1, 1) + attribute(b"Cd", 3, 0)
    names = struct.pack(">H", 4) + b"kind" + struct.pack(">Hii", 1, 4, 1) + struct.pack(">H", 5) + b"water"
    rows = b"".join(struct.pack(">7fi3fi", *p, 1, 0, 0, 1, i, 1, 0, 0, 0) for i, p in enumerate(POINTS))
    yield b"BgeoV" + struct.pack(">9i", 5, len(POINTS), 0, 0, 0, 4, 0, 0, 0) + kinds + names + rows


def vtk():
    head = "# vtk DataFile Version {}\na title\n{}\nDATASET POLYDATA\n"
    numbers = " ".join(str(x) for p in POINTS for x in p)
    counted = " ".join(str(i) for f in FACES for i in (len(f), *f))
    size = sum(len(f) + 1 for f in FACES)
    data = "POINT_DATA 5\nSCALARS id int 1\nLOOKUP_TABLE default\n0 1 2 3 4\nVECTORS velocity float\n" + "0 0 1 " * 5
    data += "\nFIELD FieldData 1\ncolor 3 5 unsigned_char\n" + "1 2 3 " * 5 + "\nMETADATA\nINFORMATION 0\n\n"
    yield (head.format("3.0", "ASCII") + f"POINTS 5 float\n{numbers}\nPOLYGONS 5 {size}\n{counted}\n" + data).encode()
    ends = [0]
    for f in FACES:
        ends.append(ends[-1] + len(f))
    corners = [i for f in FACES for i in f]
    yield (head.format("5.1", "BINARY") + "POINTS 5 float\n").encode() + floats(POINTS, ">") + \
        f"\nPOLYGONS {len(ends)} {len(corners)}\nOFFSETS vtktypeint64\n".encode() + \
        struct.pack(f">{len(ends)}q", *ends) + b"\nCONNECTIVITY vtktypeint64\n" + \
        struct.pack(f">{len(corners)}q", *corners) + b"\nPOINT_DATA 5\nFIELD FieldData 2\nid 1 5 int\n" + \
        struct.pack(">5i", *range(5)) + b"\nname 1 1 string\n\xc1a\n"
    yield (head.format("4.2", "ASCII").replace("POLYDATA", "UNSTRUCTURED_GRID") + f"POINTS 5 double\n{numbers}\n"
           "CELLS 2 9\n3 0 1 4\n4 0 1 2 3\nCELL_TYPES 2\n5 9\n").encode()

    def file(arrays, attributes="", appended=b""):
        points, ids, connectivity, offsets = arrays
        text = f"""<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" {attributes}><PolyData>
<Piece NumberOfPoints="5" NumberOfPolys="5"><Points><DataArray type="Float32" NumberOfComponents="3" {points}</DataArray>
</Points><PointData><DataArray type="Int32" Name="id" {ids}</DataArray></PointData><Polys>
<DataArray type="Int32" Name="connectivity" {connectivity}</DataArray>
<DataArray type="Int32" Name="offsets" {offsets}</DataArray></Polys></Piece></PolyData>"""
        return text.encode() + appended + b"</VTKFile>\n"
    raw = [floats(POINTS), struct.pack("<5i", *range(5)), struct.pack(f"<{len(corners)}i", *corners),
           struct.pack("<5i", *ends[1:])]
    texts = [numbers, "0 1 2 3 4", " ".join(map(str, corners)), " ".join(map(str, ends[1:]))]
    yield file([f'format="ascii">{t}' for t in texts])
    with_length = [struct.pack("<I", len(r)) + r for r in raw]
    yield file([f'format="binary">{base64.b64encode(w).decode()}' for w in with_length], 'header_type="UInt32"')
    offsets = [sum(map(len, with_length[:k])) for k in range(4)]
    yield file([f'format="appended" offset="{o}">' for o in offsets], 'header_type="UInt32"',
               b'<AppendedData encoding="raw">_' + b"".join(with_length) + b"</AppendedData>")
    packed = []
    for r in raw:
        z = zlib.compress(r)
        packed.append(base64.b64encode(struct.pack("<4I", 1, len(r), 0, len(z))) + base64.b64encode(z))
    yield file([f'format="binary">{p.decode()}' for p in packed],
               'header_type="UInt32" compressor="vtkZLibDataCompressor"')


def gltf():
    corners = [0, 1, 4, 1, 2, 4, 2, 3, 4]
    data = floats(POINTS) + struct.pack("<9H", *corners)
    file = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"children": [1], "scale": [2, 2, 2]}, {"mesh": 0, "translation": [0, 1, 0]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 5, "type": "VEC3"},
                          {"bufferView": 1, "componentType": 5123, "count": 9, "type": "SCALAR"}],
            "bufferViews": [{"buffer": 0, "byteLength": 60}, {"buffer": 0, "byteOffset": 60, "byteLength": 18}],
            "buffers": [{"byteLength": len(data)}]}
    head = json.dumps(file).encode()
    head += b" " * (-len(head) % 4)
    body = data + bytes(-len(data) % 4)
    chunks = struct.pack("<II", len(head), 0x4E4F534A) + head + struct.pack("<II", len(body), 0x004E4942) + body
    yield b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks
    file["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    yield json.dumps(file).encode()
    del file["scene"], file["scenes"]
    file["meshes"][0]["primitives"][0]["mode"] = 5
    file["nodes"][1] = {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1]}
    yield json.dumps(file).encode()


def run_record():
    yield json.dumps({
        "format": 1, "dreampm": "0.1.0", "commit": "a", "scene": "a.yaml", "variant": "preview", "scene_hash": "00",
        "status": "failed", "cause": "c", "stage": "surface",
        "machine": {"cpu": "c", "cores": 2, "threads": 2, "isa": "avx2", "memory_bytes": 1000000000},
        "particles": 8, "spacing": 0.01, "dx": 0.02, "shift": [0, 1.5, -2], "backend": "cpu",
        "bodies": [{"name": "pool", "first_id": 0, "count": 8}],
        "frames": [{"frame": 1, "time": 0.0, "substeps": 0, "state_hash": "0f", "particles": 8, "left": 0,
                    "poses": [{"name": "crate", "x": 0, "y": 1e-3, "z": 0, "qw": 1, "qx": 0, "qy": 0, "qz": 0}]}],
        "stages": {"simulate": {"seconds": 1.5, "frames": 2, "particle_steps": 9, "peak_memory_bytes": 100,
                                "settings_hash": "77", "status": "complete",
                                "volumes": [{"frame": 1, "material": "water", "particles": 0.1, "mesh": 0.1,
                                             "taken": 0.1}]},
                   "surface": {"status": "failed", "cause": "c"}, "render": {}},
        "probes": {"level": "height"}, "warnings": ["w"]}).encode()


def set():
    yield b"space.spacing=0.01\ntime.frames=3\nmaterials.water={type: newtonian, preset: honey}"
    yield b"bodies.cube.shape={sphere: {radius: 0.1}, center: [0.1, 0.2, 0.3]}\nvariants.fine=1\ndreampm=2"
    yield b"gravity=[0, -9.81, 0]\nspace.walls.floor={type: stick}\ncolliders.ball.friction=-1e400\ntime.cfl=.nan"
    yield b"materials.jelly.youngs_modulus='5'\nrender={size: [64, 36], camera: {from: [1, 1, 1], to: [0, 0, 0]}}"


def script():
    yield (b'plays dam-break\n# by hand\nsteps 20\nset gravity.y -3\nwall left drag 0.5\ndrop ball 0.1 "a word"\n'
           b'refused set spacing 0\nframes 2\npour water 0.5 0.5 0.5 0.1\nundo\n')
