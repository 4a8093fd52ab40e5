#include <catch2/catch.hpp>

#include <cstdlib>
#include <fstream>

#include "result_scene.hpp"

using namespace sunfleck;
using namespace sunfleck::test;

TEST_CASE("An ordinary reader, h5py, opens results as docs/formats-result.md says", "[result]") {
  const std::string python = "/usr/bin/python3";
  if (std::system((python + " -c 'import h5py' 2>/dev/null").c_str()) != 0) {
    WARN("skipped: " << python << " with h5py is not there");
    return;
  }
  const Folder folder;
  const Scene scene = small_scene(3000);  // several chunks
  const FacetScene facets = expand(scene);
  const PlacedScene placed = place(scene);
  const Values values(facets);
  {
    ResultWriter writer(folder / "r.h5", scene, placed, OutputChoice{}, "0.1.0", "reference");
    values.send(writer, 1000, true);
    writer.finish(small_report());
  }
  std::ofstream(folder / "irradiance.bin", std::ios::binary)
      .write(reinterpret_cast<const char*>(values.irradiance.data()),
             static_cast<std::streamsize>(values.irradiance.size() * sizeof(float)));
  std::ofstream(folder / "check.py") << R"(
import sys, h5py, numpy as np
folder = sys.argv[1]
with h5py.File(folder + "/r.h5", "r") as f:
    assert f.attrs["format"] == "sunfleck-result" and f.attrs["format_version"] == 1, dict(f.attrs)
    assert f.attrs["status"] == "converged" and f.attrs["method"] == "reference"
    assert f["facets/irradiance"].dtype == np.float32 and f["facets/centroid"].dtype == np.float64
    wanted = np.fromfile(folder + "/irradiance.bin", np.float32).reshape(f["facets/irradiance"].shape)
    assert (f["facets/irradiance"][:] == wanted).all()
    assert (f["facets/irradiance"][1, 5000:5010] == wanted[1, 5000:5010]).all()
    s, n, sides, b = wanted.shape
    m = f["organs/area"].shape[0]
    assert f["facets/organ"].dtype == np.uint32 and f["facets/organ"][:].max() == m - 1
    assert f["variance/facets"].shape == (s, n, b) and f["organs/irradiance"].shape == (s, m, 2, b)
    assert list(f["bands/name"].asstr()) == ["PAR", "NIR"]
    names = f["names/placement"].asstr()[:][f["organs/placement"][:]]
    assert names[0] == "shrub[0]" and names[-1] == "ground" and "row[0]/dark[0]" in names
    power = np.bincount(f["facets/organ"][:], f["facets/area"][:] * f["facets/absorbed"][0, :, 0].astype(float), m)
    assert np.allclose(power, f["organs/absorbed"][0, :, 0], rtol=1e-6)
    assert (f["convergence/seconds"][:] == f["timings/iteration"][:]).all()
    unlabelled = []
    f.visititems(lambda name, o: unlabelled.append(name) if isinstance(o, h5py.Dataset) and o.dtype.kind in "fiu" and "units" not in o.attrs else None)
    assert not unlabelled, unlabelled
)";
  CHECK(std::system((python + " " + (folder / "check.py") + " " + (folder / "")).c_str()) == 0);
}
