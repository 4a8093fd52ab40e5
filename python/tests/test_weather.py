import numpy as np
import pytest
from conftest import QUICK, leaves

import sunfleck
from sunfleck import weather


def epw(tmp_path, hours=range(1, 25), change=lambda h, row: row):
    lines = ["LOCATION,Testville,-,TST,x,0,45.00,10.00,1.0,250.0"] + ["HEADER"] * 7
    for h in hours:
        sun = max(0.0, np.cos((h - 12.5) / 24 * 2 * np.pi))
        row = ["2001", "6", "21", str(h), "60", "?"] + ["20"] * 7 + [f"{800 * sun:.0f}", f"{600 * sun:.0f}", f"{200 * sun:.0f}"] + ["0"] * 19
        lines.append(",".join(change(h, row)))
    (tmp_path / "w.epw").write_text("\r\n".join(lines) + "\r\n")
    return tmp_path / "w.epw"


def tmy3(tmp_path, hours=range(1, 25), value="100"):
    lines = ['1,"Testville",TS,1.0,45.0,10.0,250', "Date (MM/DD/YYYY),Time (HH:MM),ETR (W/m^2),GHI (W/m^2),DNI (W/m^2),DHI (W/m^2)"]
    lines += [f"06/21/2001,{h:02d}:00,0,{value},50,60" for h in hours]
    (tmp_path / "w.csv").write_text("\n".join(lines) + "\n")
    return tmp_path / "w.csv"


def test_epw_day(tmp_path):
    station = weather.read_epw(epw(tmp_path))
    assert (station.name, station.latitude, station.longitude, station.altitude) == ("Testville", 45, 10, 250) and station.gaps == []
    assert len(station.hours) == 24 and station.hours[11].middle.isoformat() == "2001-06-21T11:30:00+01:00"
    states = station.states(6, 21)
    assert [s["name"] for s in states] == [f"{h:02d}:30" for h in range(6, 18)]
    noon = states[6]
    assert noon["duration"] == 3600 and noon["sun"]["irradiance"]["PAR"] == pytest.approx(0.48 * 595, abs=0.5) and noon["sky"]["irradiance"]["NIR"] == pytest.approx(0.52 * 198, abs=0.5)
    scene = sunfleck.Scene(bands=["PAR", "NIR"])
    for state in states:
        scene.state(**state)
    scene.optics("leaf", reflectance={"PAR": 0.1, "NIR": 0.4})
    scene.plant("p", leaves(3), optics="leaf").place()
    result = sunfleck.solve(scene, **QUICK)
    assert result.states == [s["name"] for s in states] and np.all(result.organs.absorbed > 0) and result.daily().shape == (1, 2)


def test_the_sun_is_that_of_the_middle_of_the_hour(tmp_path):
    from sunfleck import _core

    station = weather.read_epw(epw(tmp_path))
    state = station.states(6, 21)[3]
    elevation, azimuth = _core.solar_position("2001-06-21T09:30:00+01:00", 45, 10, 250)
    assert state["sun"]["time"] == "2001-06-21T09:30:00+01:00" and 40 < elevation < 50 and 90 < azimuth < 130


def test_gaps_are_said(tmp_path):
    def without(h, row):
        return row[:13] + ["9999", "9999", "9999"] + row[16:] if h == 10 else row

    with pytest.warns(sunfleck.SceneWarning, match="2 hour.s. missing after 06-21 12:00; no irradiance for the hour that ends 06-21 10:00"):
        station = weather.read_epw(epw(tmp_path, [h for h in range(1, 25) if h not in (13, 14)], without))
    assert station.gaps == ["2 hour(s) missing after 06-21 12:00", "no irradiance for the hour that ends 06-21 10:00"]
    with pytest.warns(sunfleck.SceneWarning, match="no irradiance for the hour that ends 06-21 10:00: left out"):
        names = [s["name"] for s in station.states(6, 21)]
    assert "09:30" not in names and "12:30" not in names and "11:30" in names


def test_what_is_missing_comes_from_the_rest(tmp_path):
    def beamless(h, row):
        return row[:14] + ["9999"] + row[15:]

    states = weather.read_epw(epw(tmp_path, change=beamless)).states(6, 21)
    noon = states[6]
    from sunfleck import _core

    height = np.sin(np.radians(_core.solar_position("2001-06-21T12:30:00+01:00", 45, 10, 250)[0]))
    assert noon["sun"]["irradiance"]["PAR"] == pytest.approx(0.48 * 595 / height, rel=2e-3)


def test_light_of_a_sun_below_the_horizon_is_the_skys(tmp_path):
    states = weather.read_tmy3(tmy3(tmp_path)).states(6, 21, sky="clear")
    night = states[0]
    assert "sun" not in night and night["sky"] == {"model": "uniform", "irradiance": {"PAR": 48.0, "NIR": 52.0}}
    assert states[12]["sky"]["model"] == "clear" and states[12]["sun"]["irradiance"]["PAR"] == 24


def test_tmy3_and_errors(tmp_path):
    station = weather.read_tmy3(tmy3(tmp_path))
    assert (station.latitude, station.longitude, station.altitude, len(station.hours)) == (45, 10, 250, 24)
    with pytest.warns(sunfleck.SceneWarning, match="and 19 more"):
        assert len(weather.read_epw(epw(tmp_path, change=lambda h, r: r[:13] + ["9999"] * 3 + r[16:])).gaps) == 24
    with pytest.raises(ValueError, match="no hour of 07-01"):
        station.states(7, 1)
    (tmp_path / "bad.epw").write_text("nothing\n")
    with pytest.raises(ValueError, match=r'bad.epw:1: found "nothing"; expected LOCATION'):
        weather.read_epw(tmp_path / "bad.epw")
    with pytest.raises(ValueError, match=r'w.epw:9: found "x"; expected a number'):
        weather.read_epw(epw(tmp_path, change=lambda h, r: r[:13] + ["x"] + r[14:]))
    (tmp_path / "bad.csv").write_text('1,"T",TS,1.0,95.0,10.0,250\n')
    with pytest.raises(ValueError, match="expected a place on Earth"):
        weather.read_tmy3(tmp_path / "bad.csv")
    (tmp_path / "bad.csv").write_text('1,"T",TS,1.0,45.0,10.0,250\nDate (MM/DD/YYYY),Time (HH:MM)\n')
    with pytest.raises(ValueError, match=r"found no column GHI"):
        weather.read_tmy3(tmp_path / "bad.csv")
