"""The scenes of the report, written into its work folder, and what is run on each."""
import os, re

import numpy as np

LIGHT = '''bands = ["PAR", "NIR"]

[sun]
direction = [0.5, -0.3, 0.8]
irradiance = { PAR = 400.0, NIR = 450.0 }

[sky]
model = "standard_overcast"
irradiance = { PAR = 90.0, NIR = 60.0 }

[optics.leaf]
reflectance = { PAR = 0.09, NIR = 0.45 }
transmittance = { PAR = 0.05, NIR = 0.40 }

[optics.bark]
reflectance = { PAR = 0.20, NIR = 0.40 }
'''


class Job:
    """A method with its setting and how often it runs: a quality ('draft'; 'draft+' with the certificate), a number of samples, or a
    wanted error ('2%')."""

    def __init__(self, method, setting, runs):
        self.method, self.setting, self.runs = method, setting, runs

    def arguments(self):
        if self.method == 'reference':
            return ['--method', 'reference', '--samples', self.setting]
        what = '--error' if self.setting.endswith('%') else '--quality'
        certificate = [] if self.setting[-1] in '%+' else ['--no-certificate']  # it judges what --error chooses
        return ['--method', self.method, what, self.setting.rstrip('+'), *certificate]


class SceneChoice:
    """`write(folder, root)` writes what is needed and returns the scene's path, or None where its data are not at hand."""

    def __init__(self, name, title, write, reference_samples, jobs, dim=False):
        self.name, self.title, self.write, self.reference_samples, self.jobs = name, title, write, reference_samples, jobs
        self.dim = dim  # scattering all but switched off: shows the error of direct light alone


def jobs(runs, **settings):
    """runs = 3, clustering='draft standard', reference='16 64': one Job each; 'fine*1' runs once whatever `runs` says."""
    out = []
    for method, names in settings.items():
        for name in names.split():
            name, _, times = name.partition('*')
            out.append(Job(method, name, int(times) if times else 1 if method == 'reference' else runs))
    return out


def save(folder, name, text):
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, name)
    if not os.path.exists(path) or open(path).read() != text:
        with open(path, 'w') as f:
            f.write(text)
    return path


def random_leaves(count, lai, height, seed):
    """Corners [count, 4, 3] of square leaves of all directions alike, in a cell of 1 m x 1 m."""
    r = np.random.default_rng(seed)
    side = np.sqrt(lai / count)
    centre = np.c_[r.random(count), r.random(count), side + r.random(count) * (height - 2 * side)]
    cosine, azimuth = 2 * r.random(count) - 1, 2 * np.pi * r.random(count)
    sine = np.sqrt(1 - cosine * cosine)
    normal = np.c_[sine * np.cos(azimuth), sine * np.sin(azimuth), cosine]
    up = np.where(np.abs(normal[:, 2:]) > .9, [[1., 0, 0]], [[0, 0, 1.]])
    u = np.cross(normal, up)
    u /= np.linalg.norm(u, axis=1, keepdims=True)
    v = np.cross(normal, u)
    return np.stack([centre + side / 2 * (a * u + b * v) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))], 1)


def write_ply(path, quads):
    """A leaf shares its corners with no other, so that each is a connected component, hence an organ."""
    n = len(quads)
    faces = np.empty(2 * n, dtype=[('n', 'u1'), ('v', '<i4', 3)])
    faces['n'] = 3
    k = 4 * np.arange(n, dtype='<i4')
    faces['v'][0::2] = np.stack([k, k + 1, k + 2], 1)
    faces['v'][1::2] = np.stack([k, k + 2, k + 3], 1)
    with open(path, 'wb') as f:
        f.write(('ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n'
                 'element face %d\nproperty list uchar int vertex_indices\nend_header\n' % (4 * n, 2 * n)).encode())
        f.write(quads.astype('<f4').tobytes())
        f.write(faces.tobytes())


def canopy(facets):
    """Leaves of LAI 3 in a periodic cell."""

    def write(folder, root):
        name = 'canopy_%d' % facets
        ply = os.path.join(folder, name + '.ply')
        if not os.path.exists(ply):
            os.makedirs(folder, exist_ok=True)
            write_ply(ply + '.part', random_leaves(facets // 2, 3.0, 0.5, 1))
            os.replace(ply + '.part', ply)
        return save(folder, name + '.toml', LIGHT + '''
[domain]
periodic = [0.0, 0.0, 1.0, 1.0]

[ground]
size = [1.0, 1.0]
center = [0.5, 0.5]
cells = [20, 20]
reflectance = { PAR = 0.12, NIR = 0.20 }

[[plant]]
name = "canopy"
file = "%s.ply"
optics = { "*" = "leaf" }
place = [ { position = [0, 0, 0] } ]
''' % name)

    return write


def wheat(seeds, rows, along):
    """A periodic plot of generated wheat, rows 15 cm apart, a plant every 5 cm."""

    def write(folder, root):
        width, depth = 0.15 * rows, 0.05 * along * seeds
        text = LIGHT + '''
[domain]
periodic = [0.0, 0.0, %g, %g]

[ground]
size = [%g, %g]
center = [%g, %g]
cells = [24, 24]
reflectance = { PAR = 0.13, NIR = 0.22 }
''' % (width, depth, width, depth, width / 2, depth / 2)
        for seed in range(1, seeds + 1):
            text += '''
[[plant]]
name = "wheat_%d"
file = "%s"
seed = %d
optics = { leaf = "leaf", "*" = "leaf" }
place = [ { grid = { origin = [0.075, %g], step = [0.15, %g], count = [%d, %d], turn = "random", seed = %d } } ]
''' % (seed, os.path.join(root, 'plants', 'wheat.toml'), seed, 0.05 * (seed - 0.5), 0.05 * seeds, rows, along, seed)
        return save(folder, 'wheat_%d.toml' % (seeds * rows * along), text)

    return write


def grove(side, age, step):
    """Copies of one poplar on a square lattice, each turned its own way."""

    def write(folder, root):
        width = side * step + 2
        return save(folder, 'grove_%d.toml' % (side * side), LIGHT + '''
[ground]
size = [%g, %g]
cells = [60, 60]
reflectance = { PAR = 0.12, NIR = 0.20 }

[[plant]]
name = "poplar"
file = "%s"
age = %d
seed = 3
optics = { leaf = "leaf", bark = "bark" }
place = [ { grid = { origin = [%g, %g], step = [%g, %g], count = [%d, %d], turn = "random", seed = 1 } } ]
''' % (width, width, os.path.join(root, 'plants', 'poplar.toml'), age, -step * (side - 1) / 2, -step * (side - 1) / 2, step, step, side, side))

    return write


def of_repository(path):
    return lambda folder, root: os.path.join(root, path)


def coffee(folder, root):
    extra = os.environ.get('SUNFLECK_EXTRA_DATA')
    path = os.path.join(extra, 'scenes', 'coffee.toml') if extra else ''
    return path if os.path.exists(path) else None


def dimmed(write):
    """The same scene with reflectances and transmittances of a millionth: scattered light is traced as ever, and adds nothing."""

    def dim(folder, root):
        path = write(folder, root)
        if path is None:
            return None
        text = re.sub(r'((?:reflectance|transmittance)\w*\s*=\s*)\{[^}]*\}', r'\1{ PAR = 1e-6, NIR = 1e-6 }', open(path).read())
        here = os.path.dirname(os.path.abspath(path))
        text = re.sub(r'(\bfile\s*=\s*)"([^"]*)"', lambda m: '%s"%s"' % (m[1], os.path.join(here, m[2])), text)
        return save(folder, 'dim_' + os.path.basename(path), text)

    return dim


def overcast(write):
    """The same scene under its sky alone, without a sun."""

    def sky(folder, root):
        path = write(folder, root)
        if path is None:
            return None
        text = re.sub(r'^\[sun\]\n(?:[^\[\n].*\n|\n)*', '', open(path).read(), flags=re.M)
        return save(folder, 'sky_' + os.path.basename(path), text)

    return sky


def full():
    every = 'draft standard fine'
    return [
        SceneChoice('coffee', 'coffee, one plant of 118,798 facets on open ground (third-party)', coffee, 256,
                    jobs(3, clustering='draft standard fine*1 draft+*1 2%*4', flat='draft standard*2', instantiation='draft standard fine*1',
                         direct='draft standard*1 fine*1', lattice='draft standard*1', reference='16 64')),
        SceneChoice('wheat', 'wheat, 24 plants of 3 shapes in a periodic plot', wheat(3, 4, 2), 512,
                    jobs(3, clustering='draft standard fine*1 draft+*1 2%*4', flat='draft standard', instantiation='draft standard', direct='draft',
                         reference='16 128')),
        SceneChoice('canopy_5k', 'random canopy of 5,000 facets, periodic, LAI 3', canopy(5_000), 1024,
                    jobs(3, clustering=every + ' draft+*1 1%*8 2%*4', flat=every + ' 2%*2', direct=every, lattice='draft standard*1', reference='16 64 256')),
        SceneChoice('canopy_50k', 'random canopy of 50,000 facets, periodic, LAI 3', canopy(50_000), 256,
                    jobs(3, clustering='draft standard*2 fine*1 draft+*1 2%*3', flat='draft standard*1', direct='draft', reference='16 64')),
        SceneChoice('poplar', 'one poplar of 112,528 facets on open ground', of_repository('plants/poplar_scene.toml'), 256,
                    jobs(3, clustering='draft standard fine*1 draft+*1 3%*4', flat='draft standard*1', instantiation='draft standard', direct='draft',
                         reference='16 64')),
        SceneChoice('coffee_dim', 'coffee, direct light alone', dimmed(coffee), 64, jobs(2, clustering='draft', direct='draft standard'), dim=True),
        SceneChoice('coffee_sky', 'coffee, sky light alone', overcast(dimmed(coffee)), 64, jobs(2, direct='draft', occlusion='standard')),
        SceneChoice('canopy_5k_dim', 'canopy of 5,000 facets, direct light alone', dimmed(canopy(5_000)), 256,
                    jobs(3, clustering='draft', direct='draft standard'), dim=True),
        SceneChoice('canopy_50k_dim', 'canopy of 50,000 facets, direct light alone', dimmed(canopy(50_000)), 64,
                    jobs(2, clustering='draft', direct='draft standard'), dim=True),
        SceneChoice('poplar_dim', 'one poplar, direct light alone', dimmed(of_repository('plants/poplar_scene.toml')), 64,
                    jobs(2, clustering='draft', direct='draft standard'), dim=True),
        SceneChoice('grove', 'a grove of 16 copies of one poplar', grove(4, 5, 2.2), 32,
                    jobs(2, clustering='draft standard*1', instantiation='draft standard fine*1 draft+*1 2%*4', direct='draft', lattice='draft standard*1')),
        SceneChoice('ten_poplars', 'ten poplars, 1.2 million facets, no two alike', of_repository('plants/ten_poplars.toml'), 16,
                    jobs(1, clustering='draft standard', instantiation='draft standard fine draft+ 3%*2', direct='draft')),
        SceneChoice('canopy_1m', 'random canopy of 1,000,000 facets, periodic, LAI 3', canopy(1_000_000), 16,
                    jobs(1, clustering='draft standard', direct='draft')),
    ]


def quick():
    return [
        SceneChoice('canopy_5k', 'random canopy of 5,000 facets, periodic, LAI 3', canopy(5_000), 64,
                    jobs(2, clustering='draft standard draft+ 2%', flat='draft', direct='draft', lattice='draft', reference='16')),
        SceneChoice('wheat_small', 'wheat, 8 plants of 2 shapes in a periodic plot', wheat(2, 2, 2), 16,
                    jobs(2, clustering='draft', instantiation='draft', direct='draft')),
        SceneChoice('canopy_5k_dim', 'canopy of 5,000 facets, direct light alone', dimmed(canopy(5_000)), 64,
                    jobs(1, clustering='draft', direct='draft'), dim=True),
    ]
