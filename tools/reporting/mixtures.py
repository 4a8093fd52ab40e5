"""Small scenes that mix what a method was not made for: large beside small (1 : 1,000), inside one another, on, below and behind the ground,
slopes, periods, lamps, one organ or thousands, names or none. Scene k is the same on every machine: it comes from random.Random(k) alone."""
import math, os, random

from .scenes import save


class Mesh:
    """Polygons by organ; `None` for an organ leaves the file without names."""

    def __init__(self):
        self.vertices, self.faces = [], []  # faces: (organ, corner indices)

    def polygon(self, organ, corners):
        first = len(self.vertices) + 1
        self.vertices += corners
        self.faces.append((organ, list(range(first, first + len(corners)))))

    def text(self):
        lines = ['v %.9g %.9g %.9g' % v for v in self.vertices]
        current = None
        for organ, corners in self.faces:
            if organ is not None and organ != current:
                lines.append('g ' + organ)
                current = organ
            lines.append('f ' + ' '.join(map(str, corners)))
        return '\n'.join(lines) + '\n'


def frame(normal):
    n = math.sqrt(sum(c * c for c in normal))
    z = [c / n for c in normal]
    up = (1, 0, 0) if abs(z[2]) > .9 else (0, 0, 1)
    x = [up[1] * z[2] - up[2] * z[1], up[2] * z[0] - up[0] * z[2], up[0] * z[1] - up[1] * z[0]]
    m = math.sqrt(sum(c * c for c in x))
    x = [c / m for c in x]
    return x, [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]]


def direction(r, up=False):
    z = r.random() if up else 2 * r.random() - 1
    a, s = 2 * math.pi * r.random(), math.sqrt(1 - z * z)
    return s * math.cos(a), s * math.sin(a), z


def square(mesh, organ, centre, normal, width, length=None):
    u, v = frame(normal)
    w, h = width / 2, (length or width) / 2
    mesh.polygon(organ, [tuple(centre[i] + a * w * u[i] + b * h * v[i] for i in range(3)) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def crown(r, leaves, radius, size, height, named):
    m = Mesh()
    for k in range(leaves):
        d, q = direction(r), radius * r.random()**(1 / 3)
        square(m, 'leaf_%d' % k if named else None, (d[0] * q, d[1] * q, height + d[2] * q), direction(r), size)
    return m


def tuft(r, blades, length, width, named):
    """Blades from one foot, leaning out and bending over."""
    m = Mesh()
    for k in range(blades):
        a, lean, l = 2 * math.pi * r.random(), .2 + .9 * r.random(), length * (.6 + .4 * r.random())
        side = (-math.sin(a) * width / 2, math.cos(a) * width / 2)
        points = []
        for j in range(4):
            t = j / 3
            out, up = l * t * math.sin(lean * (.5 + .5 * t)), l * t * math.cos(lean * (.5 + .5 * t))
            taper = 1 - .8 * t
            points.append([(math.cos(a) * out + s * side[0] * taper, math.sin(a) * out + s * side[1] * taper, up + .002) for s in (-1, 1)])
        for j in range(3):
            m.polygon('blade_%d' % k if named else None, [points[j][0], points[j][1], points[j + 1][1], points[j + 1][0]])
    return m


def rosette(r, leaves, length, width):
    m = Mesh()
    for k in range(leaves):
        a, rise = 2.399963 * k, .1 + .6 * k / leaves
        d = (math.cos(a) * math.cos(rise), math.sin(a) * math.cos(rise), math.sin(rise))
        s = (-math.sin(a), math.cos(a), 0)
        at = lambda t, u: tuple(length * t * d[i] + width * u * s[i] + (.001 if i == 2 else 0) for i in range(3))
        m.polygon('leaf_%d' % k, [at(0, 0), at(.6, -.5), at(1, 0), at(.6, .5)])
    return m


def box(width, depth, height, roof=True, floor=None):
    """A house of film or boards: four walls, a roof."""
    m, w, d = Mesh(), width / 2, depth / 2
    corner = [(-w, -d), (w, -d), (w, d), (-w, d)]
    for k in range(4):
        (x, y), (p, q) = corner[k], corner[(k + 1) % 4]
        m.polygon('wall_%d' % k, [(x, y, .001), (p, q, .001), (p, q, height), (x, y, height)])
    if roof:
        m.polygon('roof', [(x, y, height) for x, y in corner])
    return m


def plate(organ, width, depth, height, tilt=0.0, towards=0.0):
    m = Mesh()
    c, s = math.cos(math.radians(towards)), math.sin(math.radians(towards))
    t, u = math.cos(math.radians(tilt)), math.sin(math.radians(tilt))
    corners = []
    for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        x, y = a * width / 2, b * depth / 2 * t
        corners.append((c * x - s * y, s * x + c * y, height + b * depth / 2 * u))
    m.polygon(organ, corners)
    return m


def hill(width, cells, ridge, sharp):
    m = Mesh()
    step = width / cells
    z = lambda i, j: ridge * math.exp(-((i * step - width / 2 + .25 * width) / (sharp * width))**2)
    at = lambda i, j: (i * step - width / 2, j * step - width / 2, z(i, j))
    for j in range(cells):
        for i in range(cells):
            m.polygon(None, [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
    return m


def places(r, count, reach, z, apart=0.0):
    out = []
    for _ in range(40 * count):
        x, y = reach * (2 * r.random() - 1), reach * (2 * r.random() - 1)
        if all((x - p[0])**2 + (y - p[1])**2 >= apart * apart for p in out):
            out.append((x, y, z, 360 * r.random()))
        if len(out) == count:
            break
    return out


class Mixture:
    def __init__(self, k):
        self.r = r = random.Random(k)
        self.name = 'mixture_%02d' % k
        self.plants, self.parts, self.ground = [], [], None
        self.ground_height = lambda x, y: 0.0
        self.periodic = None
        self.light = []
        width = r.choice([1.0, 2.0, 4.0])
        self.reach = width / 2
        kind = ['flat', 'flat', 'coarse', 'hill', 'slope', 'period', 'period', 'none'][k % 8]
        self.lay_ground(kind, width)
        self.grow(width)
        for thing in self.things(k):
            getattr(self, thing)(width)
        self.shine(k)

    # -- ground
    def lay_ground(self, kind, width):
        r = self.r
        self.parts.append(kind)
        optics = 'reflectance = { P = %.2f, N = %.2f }' % (.08 + .15 * r.random(), .15 + .3 * r.random())
        if kind == 'none':
            return
        if kind in ('hill', 'slope'):
            if kind == 'hill':
                height, sharp = width * (.25 + .5 * r.random()), .12
                mesh = hill(2 * width, 24, height, sharp)
                self.ground_height = lambda x, y: height * math.exp(-((x + .5 * width) / (sharp * 2 * width))**2) + .002
            else:
                gx, gy = .6 * (r.random() - .5), .6 * (r.random() - .5)
                mesh = Mesh()
                w = 1.5 * width
                mesh.polygon(None, [(x * w, y * w, gx * x * w + gy * y * w) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
                self.ground_height = lambda x, y: gx * x + gy * y + .002
            self.ground = ('mesh', mesh, optics)
            return
        size = width if kind == 'period' else 1000.0 if kind == 'coarse' else 2 * width
        cells = 10 if kind == 'coarse' else r.choice([1, 4, 20])
        if kind == 'period':
            self.periodic = (-width / 2, -width / 2, width / 2, width / 2)
        self.ground = ('flat', size, cells, optics)

    # -- what grows
    def add(self, name, mesh, optics, at):
        self.plants.append((name, mesh, optics, at))

    def grow(self, width):
        r = self.r
        what = r.choice(['tufts', 'crowns', 'rosettes', 'small leaves', 'big leaves', 'one organ'])
        self.parts.append(what)
        named = r.random() < .7
        if what == 'tufts':
            count = r.choice([4, 9])
            self.stand('tuft', tuft(r, r.choice([12, 30]), .15 * width, .01 * width, named), count, width)
        elif what == 'crowns':
            self.stand('crown', crown(r, r.choice([60, 200]), .12 * width, .03 * width, .2 * width, named), r.choice([3, 6]), width)
        elif what == 'rosettes':
            self.stand('rosette', rosette(r, r.choice([8, 16]), .12 * width, .04 * width), r.choice([5, 12]), width)
        elif what == 'small leaves':
            self.stand('shrub', crown(r, 1500, .1 * width, .005 * width, .12 * width, named), 2, width)
        elif what == 'big leaves':
            self.stand('banana', crown(r, 8, .25 * width, .2 * width, .35 * width, True), 3, width)
        else:
            self.stand('bush', crown(r, 300, .2 * width, .03 * width, .25 * width, True), 1, width, one_organ=True)

    def stand(self, name, mesh, count, width, one_organ=False):
        if one_organ:
            mesh.faces = [('all', corners) for _, corners in mesh.faces]
        at = [(x, y, self.ground_height(x, y), turn) for x, y, _, turn in places(self.r, count, .45 * width, 0, .2 * width)]
        self.add(name, mesh, 'leaf', at)

    # -- what else stands there
    def things(self, k):
        all_things = ['panel', 'house', 'film', 'big_leaf_over', 'wall', 'below', 'grass_among', 'hedge', 'stone', 'lamp', 'nothing', 'tiny']
        return self.r.sample(all_things, self.r.choice([1, 2, 2, 3]))

    def panel(self, width):
        self.parts.append('panel')
        self.add('panel', plate('panel', .8 * width, .5 * width, (.5 + .3 * self.r.random()) * width + self.top(), 30 * self.r.random(), 360 * self.r.random()),
                 'panel', [(0, 0, 0, 0)])

    def top(self):
        return max(0.0, max(self.ground_height(x * self.reach / 4, y * self.reach / 4) for x in range(-8, 9) for y in range(-8, 9)) if self.ground else 0.0)

    def house(self, width):
        self.parts.append('house')
        side = .9 * width if self.periodic else 1.3 * width
        self.add('house', box(side, side, .9 * width + self.top()), self.r.choice(['film', 'boards_open'][:1]), [(0, 0, 0, 0)])

    def film(self, width):
        if not self.ground or self.ground[0] != 'flat':
            return
        self.parts.append('film on the ground')
        self.add('film', plate('film', .5 * width, .6 * width, 0.0), 'mulch', [(.1 * width, 0, 0, 0)])

    def big_leaf_over(self, width):
        self.parts.append('large leaf above')
        self.add('roof', plate('blade', .5 * width, .5 * width, .6 * width + self.top(), 20, 40), 'leaf', [(-.1 * width, .1 * width, 0, 0)])

    def wall(self, width):
        self.parts.append('wall')
        m = Mesh()
        m.polygon('wall', [(-.45 * width, .47 * width, -.01), (.45 * width, .47 * width, -.01), (.45 * width, .47 * width, .7 * width + self.top()),
                           (-.45 * width, .47 * width, .7 * width + self.top())])
        self.add('wall', m, 'boards', [(0, 0, 0, 0)])

    def below(self, width):
        if not self.ground or self.periodic:
            return
        self.parts.append('below the ground')
        self.add('roots', crown(self.r, 20, .1 * width, .03 * width, -.3 * width - self.top(), True), 'leaf', [(0, 0, 0, 0)])

    def grass_among(self, width):
        self.parts.append('grass among them')
        self.stand('grass', tuft(self.r, 8, .05 * width, .003 * width, True), 30, width)

    def hedge(self, width):
        self.parts.append('hedge through them')
        m = Mesh()
        for k in range(150):
            c = (.9 * width * (self.r.random() - .5), .1 * width * (self.r.random() - .5), .02 * width + .3 * width * self.r.random() + self.top())
            square(m, 'h_%d' % k, c, direction(self.r), .04 * width)
        self.add('hedge', m, 'leaf', [(0, 0, 0, 0)])

    def stone(self, width):
        self.parts.append('block')
        self.add('block', box(.2 * width, .2 * width, .15 * width), 'boards', [(-.25 * width, -.25 * width, self.ground_height(-.25 * width, -.25 * width), 20)])

    def tiny(self, width):
        self.parts.append('a thousandth as large')
        self.stand('speck', crown(self.r, 40, .004 * width, .001 * width, .006 * width, True), 4, width)

    def lamp(self, width):
        self.parts.append('lamp')
        m = Mesh()
        h = .8 * width + self.top()
        m.polygon(None, [(-.1 * width, -.1 * width, h), (-.1 * width, .1 * width, h), (.1 * width, .1 * width, h), (.1 * width, -.1 * width, h)])
        self.light.append(('lamp', m))

    def nothing(self, width):
        pass

    # -- light
    def shine(self, k):
        r = self.r
        az, el = 360 * r.random(), r.choice([15, 30, 50, 75, 90])
        self.sun = (el, az, r.choice([0.0, .53, .53, 5.0])) if r.random() < .85 else None
        self.sky = r.choice(['standard_overcast', 'uniform', 'clear']) if r.random() < .8 or not self.sun else None
        if self.sky == 'clear' and not self.sun:
            self.sky = 'uniform'

    def write(self, folder):
        text = 'bands = ["P", "N"]\n'
        if self.periodic:
            text += '[domain]\nperiodic = [%g, %g, %g, %g]\n' % self.periodic
        if self.sun:
            text += '[sun]\nelevation = %g\nazimuth = %.3f\nirradiance = { P = 400, N = 450 }\nangular_diameter = %g\n' % self.sun
        if self.sky:
            text += '[sky]\nmodel = "%s"\nirradiance = { P = 100, N = 80 }\n' % self.sky
        for k, (what, mesh) in enumerate(self.light):
            save(folder, '%s_lamp%d.obj' % (self.name, k), mesh.text())
            text += '[[lamp]]\nmesh = "%s_lamp%d.obj"\nexitance = { P = 900, N = 500 }\n' % (self.name, k)
        text += '''[optics.leaf]
reflectance_front = { P = 0.08, N = 0.45 }
reflectance_back = { P = 0.12, N = 0.48 }
transmittance = { P = 0.05, N = 0.42 }
[optics.panel]
reflectance = { P = 0.06, N = 0.2 }
[optics.film]
reflectance = { P = 0.1, N = 0.1 }
transmittance = { P = 0.7, N = 0.75 }
[optics.boards]
reflectance = { P = 0.4, N = 0.5 }
[optics.mulch]
reflectance = { P = 0.5, N = 0.4 }
transmittance = { P = 0.1, N = 0.2 }
'''
        if self.ground:
            text += '[ground]\n' + self.ground[-1] + '\n'
            if self.ground[0] == 'mesh':
                save(folder, self.name + '_ground.obj', self.ground[1].text())
                text += 'mesh = "%s_ground.obj"\n' % self.name
            else:
                text += 'size = [%g, %g]\ncenter = [0, 0]\ncells = [%d, %d]\n' % (self.ground[1], self.ground[1], self.ground[2], self.ground[2])
        for name, mesh, optics, at in self.plants:
            save(folder, '%s_%s.obj' % (self.name, name), mesh.text())
            text += '[[plant]]\nname = "%s"\nfile = "%s_%s.obj"\noptics = { "*" = "%s" }\nplace = [\n' % (name, self.name, name, optics)
            text += ''.join('  { position = [%.6f, %.6f, %.6f], turn = %.3f },\n' % p for p in at) + ']\n'
        text += '[output]\nfacets = false\n'
        return save(folder, self.name + '.toml', text)


def mixtures(count):
    return [Mixture(k) for k in range(count)]
