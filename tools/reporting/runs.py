"""Runs the program, each run a process of its own, and keeps what each gave as a line of JSON, so that a stopped report goes on."""
import hashlib, json, os, re, subprocess, sys, tempfile, time

import h5py
import numpy as np


def say(line):
    print(line, file=sys.stderr, flush=True)


class Failed(Exception):
    pass


def run(program, *arguments, accepted=(0,)):
    """Standard output, exit code, processor seconds (user + system) and wall seconds of one process."""
    with tempfile.TemporaryFile('w+') as out, tempfile.TemporaryFile('w+') as err:
        start = time.monotonic()
        child = subprocess.Popen([program, *arguments], stdout=out, stderr=err)
        try:
            _, status, used = os.wait4(child.pid, 0)
        except BaseException:
            child.terminate()
            child.wait()
            raise
        wall = time.monotonic() - start
        child.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0), err.seek(0)
        if child.returncode not in accepted:
            raise Failed('%s %s: exit %d\n%s' % (program, ' '.join(arguments), child.returncode, err.read()))
        return out.read(), child.returncode, used.ru_utime + used.ru_stime, wall


def sha256(path):
    digest = hashlib.sha256()
    with open(path, 'rb') as f:
        for block in iter(lambda: f.read(1 << 20), b''):
            digest.update(block)
    return digest.hexdigest()


def noise_of(path):
    """Of a result of the reference method, by its stored variances: {'organs': {band: n}, 'facets': {band: n}}, relative to the mean."""
    with h5py.File(path) as f:
        bands = [b.decode() for b in f['bands/name'][:]]
        ground = [k for k, name in enumerate(f['names/type'][:]) if name == b'ground']
        plant = ~np.isin(f['organs/type'][:], ground)
        organ_area = f['organs/area'][:].astype(float)
        out = {}
        for what in ('organs', 'facets'):
            if 'variance/' + what not in f:
                continue
            area = organ_area if what == 'organs' else f['facets/area'][:].astype(float)
            keep = (plant if what == 'organs' else plant[f['facets/organ'][:]]) & (area > 0)
            w = area[keep]
            variance = f['variance/' + what][:][:, keep].astype(float)  # [s, m, b]
            absorbed = f[what + '/absorbed'][:][:, keep].astype(float)
            if what == 'organs':  # of powers
                variance, absorbed = variance / w[None, :, None]**2, absorbed / w[None, :, None]
            states = variance.shape[0]
            mean = np.einsum('m,smb->b', w, absorbed) / (w.sum() * states)
            square = np.einsum('m,smb->b', w, variance) / (w.sum() * states)
            out[what] = {b: float(n) for b, n in zip(bands, np.sqrt(square) / np.maximum(mean, 1e-300))}
        return out


def facts_of(path):
    with h5py.File(path) as f:
        out = {'counts': {k.decode(): int(v) for k, v in zip(f['counts/name'][:], f['counts/value'][:])},
               'peak_bytes': int(f['memory'].attrs['peak_resident_bytes']),
               'iterations': int(len(f['convergence/residual'])),
               'facets': int(f['facets/area'].shape[0]), 'organs': int(f['organs/area'].shape[0])}
        if 'certificate' in f:
            out['certificate'] = {k: [float(v) for v in f['certificate'].attrs[k]] for k in ('rmse', 'rmse_low', 'rmse_high')}
        return out


def hash_of_scene(path):
    """Of the scene file and of the files that it names."""
    text = open(path).read()
    here = os.path.dirname(os.path.abspath(path))
    named = [os.path.join(here, name) for name in re.findall(r'\bfile\s*=\s*"([^"]*)"', text)]
    return hashlib.sha256((text + ''.join(sha256(n) for n in named)).encode()).hexdigest()[:16]


class Runs:
    """Finished runs of one program, in work/runs.jsonl; references in work/references."""

    def __init__(self, program, work, threads, commit):
        self.program, self.work, self.threads, self.commit = program, work, threads, commit
        self.hash = sha256(program)[:16]
        os.makedirs(os.path.join(work, 'references'), exist_ok=True)
        self.file = os.path.join(work, 'runs.jsonl')
        self.done, self.hashes = {}, {}
        if os.path.exists(self.file):
            for line in open(self.file):
                try:
                    record = json.loads(line)
                except ValueError:  # cut off when the report was stopped
                    continue
                if record['program'] == self.hash and record['threads'] == threads or record['method'] == 'reference':
                    self.done[self.key(record)] = record

    def hash_of(self, scene_path):
        if scene_path not in self.hashes:
            self.hashes[scene_path] = hash_of_scene(scene_path)
        return self.hashes[scene_path]

    @staticmethod
    def key(r):
        return (r['scene'], r['scene_hash'], r['method'], r['setting'], r['seed'])

    def _solve(self, scene_path, result, seed, arguments):
        arguments = ['solve', scene_path, '-o', result, '--threads', str(self.threads), '--seed', str(seed), *arguments]
        _, code, cpu, wall = run(self.program, *arguments, accepted=(0, 3))
        return {'program': self.hash, 'commit': self.commit, 'threads': self.threads, 'arguments': arguments, 'exit': code, 'cpu_s': cpu, 'wall_s': wall,
                **facts_of(result)}

    def _keep(self, record):
        self.done[self.key(record)] = record
        with open(self.file, 'a') as f:
            f.write(json.dumps(record) + '\n')

    def reference(self, scene, scene_path):
        """Path to the scene's reference; traced where it is not there yet. It does not depend on the program's version."""
        scene_hash = self.hash_of(scene_path)
        path = os.path.join(self.work, 'references', '%s-%s-%d.h5' % (scene.name, scene_hash, scene.reference_samples))
        key = {'scene': scene.name, 'scene_hash': scene_hash, 'method': 'reference', 'setting': str(scene.reference_samples), 'seed': 1000}
        if not os.path.exists(path) or self.key(key) not in self.done:
            part = path[:-3] + '.part.h5'
            facts = self._solve(scene_path, part, 1000, ['--method', 'reference', '--samples', str(scene.reference_samples)])
            noise = noise_of(part)
            os.replace(part, path)
            self._keep({**key, **facts, 'noise': noise})
            say('%-16s reference, %d samples: %.1f CPU s, noise %s' % (scene.name, scene.reference_samples, facts['cpu_s'], percent(noise['organs'])))
        return path

    def job(self, scene, scene_path, job, seed, reference):
        """The record of one run, done now where it is not done yet."""
        key = {'scene': scene.name, 'scene_hash': self.hash_of(scene_path), 'method': job.method, 'setting': job.setting, 'seed': seed}
        if self.key(key) in self.done:
            return self.done[self.key(key)]
        with tempfile.TemporaryDirectory(dir=self.work) as folder:
            result = os.path.join(folder, 'result.h5')
            record = {**key, **self._solve(scene_path, result, seed, job.arguments())}
            if job.method == 'reference':
                record['noise'] = noise_of(result)
                shown = percent(record['noise']['organs'])
            else:
                table = json.loads(run(self.program, 'compare', result, reference, '--json')[0])
                record['error'] = {what: {b: {k: e[k] for k in ('rmse', 'bias', 'maximum')} for b, e in table[what].items()}
                                   for what in ('organs', 'facets')}
                shown = percent({b: e['rmse'] for b, e in record['error']['organs'].items()})
        self._keep(record)
        say('%-16s %s %s, seed %d: %.2f CPU s, %s %s' % (scene.name, job.method, job.setting, seed, record['cpu_s'],
                                                       'noise' if job.method == 'reference' else 'error', shown))
        return record


def percent(by_band):
    return ' / '.join('%.2f' % (100 * v) for v in by_band.values()) + ' %'
