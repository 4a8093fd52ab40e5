"""Writes the report's page and its plots from the runs."""
import os

from . import svg
from .figures import Point, curve, for_both, half_interval, mean, path_tracing

AIMS = {'PAR': 1.0, 'NIR': 2.0}  # per cent: what times at equal error are compared at
ORDER = ['instantiation', 'clustering', 'flat', 'direct', 'lattice', 'occlusion', 'reference']
LARGE = {'canopy_1m': 'canopy_50k', 'canopy_50k': 'canopy_5k'}  # noise against samples as on the smaller of the same kind


def seconds(t):
    return '-' if t is None else '%.2f' % t if t < 10 else '%.0f' % t


def table(head, rows):
    return '\n'.join(['| ' + ' | '.join(head) + ' |', '|' + '---|' * len(head)] + ['| ' + ' | '.join(r) + ' |' for r in rows])


def bytes_text(n):
    return '%d MB' % round(n / 1e6) if n < 1e9 else '%.2f GB' % (n / 1e9)


class Document:
    def __init__(self, scenes, records, machine, command, images):
        self.scenes, self.machine, self.command, self.images = scenes, machine, command, images
        self.points = {}
        groups = {}
        for r in records:
            groups.setdefault((r['scene'], r['method'], r['setting']), []).append(r)
        reference = {s.name: groups.get((s.name, 'reference', str(s.reference_samples)), [None])[0] for s in scenes}
        for (scene, *_), rs in groups.items():
            self.points.setdefault(scene, []).append(Point(rs, reference[scene]))
        for ps in self.points.values():
            ps.sort(key=lambda p: (ORDER.index(p.method), p.cpu))
        self.scenes = [s for s in scenes if any(p.method != 'reference' for p in self.points.get(s.name, []))]
        self.skipped = [s for s in scenes if s not in self.scenes]

    def of(self, scene, method):
        return [p for p in self.points.get(scene, []) if p.method == method and not p.certified]

    def certificate_seconds(self, scene, method):
        """What the certificate adds to a draft: of this method, or of clustering, which traces the same facets."""
        for m in (method, 'clustering'):
            cpu = {p.setting: p.cpu for p in self.points[scene] if p.method == m}
            if 'draft+' in cpu and 'draft' in cpu:
                return max(0.0, cpu['draft+'] - cpu['draft'])
        return None

    def bands(self, scene):
        p = self.points[scene][0]
        return list((p.records[0].get('noise') or p.records[0]['error'])['organs'])

    # --- times at equal error ---
    def traced(self, scene, band, aim):
        return path_tracing(self.of(scene, 'reference'), band, aim, self.of(LARGE.get(scene), 'reference'))

    def best(self, scene, aims=AIMS):
        """(method, CPU seconds) of the quickest of ours for these errors."""
        found = []
        for method in ('instantiation', 'clustering', 'flat'):
            t = for_both(lambda b, a: curve(self.of(scene, method), b, a), aims)
            if t is not None:
                found.append((t, method))
        return min(found) if found else (None, None)

    def equal_error(self):
        rows = []
        for s in self.scenes:
            if s.dim:
                continue
            by = {m: for_both(lambda b, a: curve(self.of(s.name, m), b, a), AIMS) for m in ('instantiation', 'clustering', 'flat')}
            traced = for_both(lambda b, a: self.traced(s.name, b, a), AIMS)
            best, method = self.best(s.name)
            rows.append([s.name, seconds(by['instantiation']), seconds(by['clustering']), seconds(by['flat']), seconds(traced),
                         '%.0f (%s)' % (traced / best, method) if best and traced else '-'])
        return table(['scene', 'instantiation, CPU s', 'clustering, CPU s', 'flat, CPU s', 'path tracing, CPU s', 'path tracing / best'], rows) + (
            '\n\n"-": no quality that was run is as exact, or the reference is too noisy to tell.')

    def ratio(self, scene):
        traced = for_both(lambda b, a: self.traced(scene, b, a), AIMS) if scene in self.points else None
        best, method = self.best(scene) if traced else (None, None)
        return (traced / best, method) if best else (None, None)

    # --- direct light ---
    def direct_rows(self):
        """Draft's time on the scene against the time of method direct with the same error of direct light."""
        rows = []
        for s in self.scenes:
            dim = s.name + '_dim'
            if s.dim or dim not in self.points:
                continue
            for method in ('clustering',):
                draft = [p for p in self.of(s.name, method) if p.setting == 'draft']
                own = [p for p in self.of(dim, method) if p.setting == 'draft']
                if not draft or not own:
                    continue
                error = own[0].error('organs', 'PAR')
                direct = self.of(dim, 'direct')
                t = curve(direct, 'PAR', error)
                cheapest = min(direct, key=lambda p: p.cpu)
                rows.append((s.name, method, draft[0].cpu, error, cheapest.error('organs', 'PAR'), cheapest.cpu, t))
        return rows

    # --- claims ---
    def claims(self):
        out = []
        for scene, aim in (('coffee', 20), ('canopy_1m', 50)):
            if scene not in [s.name for s in self.scenes + self.skipped]:  # of another set of scenes
                continue
            ratio, method = self.ratio(scene)
            what = 'At equal error (1 %% PAR and 2 %% NIR per organ), solving `%s` is at least %d times cheaper than tracing its paths' % (scene, aim)
            if scene not in [s.name for s in self.scenes]:
                out.append('- %s: **not known**, it was not run.' % what)
            elif ratio is None:
                out.append('- %s: **cannot be told**, no setting that was run reaches it.' % what)
            else:
                out.append('- %s: **%s**, %.0f times with `%s`.' % (what, 'met' if ratio >= aim else 'missed', ratio, method))
        for scene, method, t, error, e_direct, t_cheapest, t_equal in self.direct_rows():
            ratio = None if t_equal is None else t / t_equal
            out.append('- `draft` on `%s` takes at most 3 times `--method direct` with the same error of the direct light (%.2f %% PAR): **%s**, %s.' % (
                scene, error, 'cannot be told' if ratio is None else 'met' if ratio <= 3 else 'missed',
                'no quality of `direct` is as exact' if ratio is None else '%.1f times (%s against %s CPU s)' % (ratio, seconds(t), seconds(t_equal))))
        return '\n'.join(out)

    def losses(self):
        """Where ours is not the best choice, or an aim of a quality is missed."""
        out = []
        aims = {'draft': (4, 6), 'standard': (1, 2), 'fine': (0.7, 1.2)}
        for s in self.scenes:
            if s.dim:
                continue
            for method in ('instantiation', 'clustering', 'flat'):
                misses, biased = [], []
                for p in self.of(s.name, method):
                    if p.setting not in aims:
                        continue
                    if any(p.seen('organs', b) and p.error('organs', b) > aim for b, aim in zip(AIMS, aims[p.setting])):
                        misses.append('%s at `%s` (aims at %g / %g)' % (' / '.join('%.2f' % p.error('organs', b) for b in AIMS), p.setting, *aims[p.setting]))
                    biases = [p.bias('organs', b) for b in AIMS]
                    if max(map(abs, biases)) > 0.3 and p.setting != 'draft':
                        biased.append('%s at `%s`' % (' / '.join('%+.2f' % b for b in biases), p.setting))
                if misses:
                    out.append('- `%s`, `%s` misses the aims of its qualities, %% PAR / NIR: %s.' % (s.name, method, '; '.join(misses)))
                if biased:
                    out.append('- `%s`, `%s` is biased by more than 0.3 %%, %% PAR / NIR: %s.' % (s.name, method, '; '.join(biased)))
            times = {m: for_both(lambda b, a: curve(self.of(s.name, m), b, a), AIMS) for m in ('instantiation', 'clustering', 'flat')}
            if times['instantiation'] and times['clustering'] and times['instantiation'] > times['clustering']:
                out.append('- `%s`: instantiation is slower than clustering at equal error (%s against %s CPU s).' %
                           (s.name, seconds(times['instantiation']), seconds(times['clustering'])))
            if times['flat'] and times['clustering'] and times['flat'] < 0.9 * times['clustering']:
                out.append('- `%s`: clusters do not pay, flat is quicker at equal error (%s against %s CPU s).' %
                           (s.name, seconds(times['flat']), seconds(times['clustering'])))
            ratio, method = self.ratio(s.name)
            if ratio is not None and ratio < 20:
                out.append('- `%s`: only %.0f times cheaper than path tracing at 1 / 2 %%.' % (s.name, ratio))
            for p in self.of(s.name, 'clustering'):
                if p.setting == 'fine' and max(p.error('facets', b) / p.error('organs', b) for b in AIMS) > 2:
                    out.append('- `%s`: a single facet is known far less well than its organ: %s at `fine`, %% PAR / NIR.' % (
                        s.name, ' / '.join('%.1f against %.2f' % (p.error('facets', b), p.error('organs', b)) for b in AIMS)))
        return '\n'.join(out) or '- Nowhere among these runs.'

    # --- wanted errors ---
    def wanted(self):
        rows, kept, all_runs, slow = [], 0, 0, 0
        for s in self.scenes:
            for p in self.points[s.name]:
                if not p.setting.endswith('%'):
                    continue
                aim = float(p.setting[:-1])
                errors = [max(100 * r['error']['organs'][b]['rmse'] for b in AIMS) for r in p.records]
                said = [r['exit'] for r in p.records]
                hand = for_both(lambda b, a: curve(self.of(s.name, p.method), b, a), {b: aim for b in AIMS})
                certificate = self.certificate_seconds(s.name, p.method)
                hand = None if hand is None or certificate is None else hand + certificate
                held = sum(e <= aim for e in errors)
                kept, all_runs = kept + held, all_runs + len(errors)
                slow += hand is not None and p.cpu > 2 * hand
                rows.append([s.name, p.method, p.setting, '%d of %d' % (held, len(errors)), '%.2f' % mean(errors),
                             str(sum(x == 3 for x in said)), seconds(p.cpu), seconds(hand), '-' if hand is None else '%.1f' % (p.cpu / hand)])
        if not rows:
            return ''
        return '''## A wanted error
`--error E`: the solver chooses its densities by a pilot and a certificate ([how to](how-to.md#choose-accuracy-against-time)). The same error is asked for both bands; "hand-tuned" is the time
between the qualities at which the error would be just that, and of the certificate that ends every solve. "Said that it cannot" are runs that ended with exit code 3.

%s

%d of %d runs (%.0f %%; aim 95 %%) have a true error of at most E; %d of %d settings take more than twice the hand-tuned time.
''' % (table(['scene', 'method', 'wanted', 'runs within', 'true error %, worst band', 'said that it cannot', 'CPU s', 'hand-tuned, CPU s', 'ratio'], rows),
            kept, all_runs, 100.0 * kept / all_runs, slow, len(rows))

    # --- scenes ---
    def picture(self, s):
        rows = []
        for label, x_of, x_format in (('CPU seconds of the whole process', lambda p: p.cpu, svg.number),
                                      ('peak memory', lambda p: p.peak, bytes_text)):
            row = []
            for band in self.bands(s.name):
                series = {}
                for p in self.points[s.name]:
                    if p.certified:
                        continue
                    error = p.error('organs', band)
                    low, high = p.interval('organs', band)
                    series.setdefault(p.method, []).append((x_of(p), max(error, 1e-3), low, high, p.setting))
                row.append((band, label, series, x_format))
            rows.append(row)
        name = 'report-%s.svg' % s.name
        with open(os.path.join(self.images, name), 'w') as f:
            f.write(svg.plot(rows))
        return name

    def scene_table(self, s):
        bands, rows = self.bands(s.name), []
        for p in self.points[s.name]:
            if p.certified:
                continue

            def cell(what, band):
                e, (low, high) = p.error(what, band), p.interval(what, band)
                if not p.seen(what, band):
                    return '&lt; %.2f' % e
                return '%.2f' % e if high is None else '%.2f &plusmn; %.2f' % (e, high - e)

            biases = ' / '.join('%+.2f' % p.bias('organs', b) for b in bands) if not p.noise else '0 / 0'
            work = ', '.join('%s %s' % ('{:,}'.format(n), k.replace('_', ' ')) for k, n in p.counts.items()
                             if k in ('links', 'fragments', 'line_fragments', 'direct_fragments', 'sun_fragments', 'gather_fragments', 'rays', 'gather_rays'))
            rows.append(['path tracing' if p.method == 'reference' else p.method, p.setting, str(len(p.records)), seconds(p.cpu), seconds(p.wall),
                         bytes_text(p.peak), ' | '.join(cell('organs', b) for b in bands), biases, ' / '.join('%.1f' % p.error('facets', b) for b in bands), work])
        head = ['method', 'setting', 'runs', 'CPU s', 'wall s', 'peak'] + ['organs %s %%' % b for b in bands] + ['bias %', 'facets %', 'work']
        return table(head, rows)

    def text(self):
        m = self.machine
        parts = ['''# Error against run time

Written by `tools/report` from its runs; do not edit. Run it again: `%s` (`tools/report --help`; it goes on where it was stopped, `--quick` takes a minute or two).

Machine: %s. Compiler: %s. Commit %s, built for `%s`, %s. Each run is a process of its own, runs of all methods take turns, each with another seed. **CPU s** is user plus system time of the
whole process, reading and writing included, the certificate left out (`--no-certificate`), and is what all comparisons here use, since the machine may have had other work; **wall s** is beside
it. **Peak** is the largest resident memory.

**Error**: rms over organs (or facets) of absorbed light per area against a path-traced reference of the same scene, weighted by area, relative to the mean, the reference's own noise taken out
([definition](formats-result.md#error-of-a-result-against-a-reference)). &plusmn; and bars in the plots: 95 %% interval of the mean over seeds (Student); none where a setting ran once. What path tracing
leaves is its noise. `<`: below what the reference's noise lets see; such an error counts as this bound. Where it has to be compared at an error that it was not run at, its time is interpolated between its runs, and beyond them goes as 1 / error^2; for a large canopy that
was traced once the shape of that curve is the next smaller one's. Ours are interpolated between qualities, never extrapolated: where even the cheapest is more exact, its time stands.

`instantiation` is the program's own choice only where copies repeat and stand free ([instantiation](instantiation.md)); it runs here on other scenes too (`coffee` and `poplar` repeat nothing, plants of
`wheat` reach into each other), to show what it gives there.

`lattice` and `occlusion` are approximate and run beside the others on some scenes, to show what such shortcuts are worth ([how wrong they are](approximate-methods.md)).
''' % (self.command, m['machine'], m['compiler'], m['commit'], m['isa'], m['threads']),
                 '## What the figures say', self.claims(), '\n### CPU seconds for 1 % PAR and 2 % NIR per organ', self.equal_error(), '\n### Where we lose', self.losses()]
        rows = self.direct_rows()
        if rows:
            parts += ['''
## Draft against direct light alone
The error of the direct part of a full solve shows where reflectance and transmittance are a millionth: all is traced as ever, and scattering adds nothing.
''', table(['scene', 'method', 'draft, CPU s', 'error of its direct part, PAR %', 'error of direct at draft, PAR %', 'its CPU s', 'direct with the same error, CPU s', 'ratio'],
           [[n, me, seconds(t), '%.2f' % e, '%.2f' % ed, seconds(tc), seconds(te), '-' if te is None else '%.1f' % (t / te)] for n, me, t, e, ed, tc, te in rows])]
        parts.append('\n' + self.wanted())
        for s in self.scenes:
            r = self.points[s.name][0].records[0]
            parts.append('## %s: %s' % (s.name, s.title))
            parts.append('%s facets, %s organs (ground included).\n' % ('{:,}'.format(r['facets']), '{:,}'.format(r['organs'])))
            if not s.dim:
                parts.append('![Error over CPU seconds and over memory](images/%s)\n' % self.picture(s))
            parts.append(self.scene_table(s))
            parts.append(self.commands(s))
        missing = self.missing()
        if missing:
            parts.append('## Not run\nThe same command goes on with these; nothing above speaks of them.\n' + missing)
        return '\n'.join(p for p in parts if p) + '\n'

    def missing(self):
        """Scenes and settings without a run."""
        out = []
        for s in self.scenes + self.skipped:
            if s.name in self.machine['absent']:
                out.append('- `%s` (%s): its data are not at hand (`SUNFLECK_EXTRA_DATA`).' % (s.name, s.title))
                continue
            done = {(p.method, p.setting): len(p.records) for p in self.points.get(s.name, [])}
            if not done or set(done) == {('reference', str(s.reference_samples))}:
                out.append('- `%s` (%s): nothing%s.' % (s.name, s.title, ' but the reference' if done else ''))
                continue
            left = ['%s %s%s' % (j.method, j.setting, ' (%d of %d)' % (done[j.method, j.setting], j.runs) if (j.method, j.setting) in done else '')
                    for j in s.jobs if done.get((j.method, j.setting), 0) < j.runs]
            if left:
                out.append('- `%s`: %s.' % (s.name, ', '.join(left)))
        return '\n'.join(out)

    def commands(self, s):
        lines = []
        for p in self.points[s.name]:
            a = p.records[0]['arguments']
            lines.append('sunfleck solve %s -o RESULT.h5 %s' % (self.machine['shown'](a[1]), ' '.join(a[4:])))
        lines.append('sunfleck compare RESULT.h5 REFERENCE.h5 --json')
        return '\n<details><summary>Commands (seeds count from 1; the reference: seed 1000)</summary>\n\n```\n%s\n```\n</details>\n' % '\n'.join(lines)
