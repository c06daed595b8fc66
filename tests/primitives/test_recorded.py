"""Recorded paths are read, checked and resampled."""

from __future__ import annotations

import warnings
from datetime import datetime, timedelta
from pathlib import Path
from time import process_time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.primitives.recorded import Format, demonstrations, read_corners, read_path, resampled

numbers = st.integers(-100_000, 100_000).map(lambda thousandths: thousandths / 1000)
instants = st.lists(st.floats(1e-3, 10), min_size=2, max_size=30).map(lambda steps: np.cumsum([0.0, *steps]))


@settings(deadline=None, max_examples=50)
@given(st.lists(st.tuples(st.floats(1e-3, 10), numbers, numbers), min_size=2, max_size=20), st.integers(2, 200))
def test_resampling_keeps_the_end_points_and_the_range(rows, samples) -> None:
    steps, *path = np.array(rows).T
    time, path = np.cumsum(steps), np.transpose(path)
    new = resampled(time, path, samples)
    assert new.shape == (samples, 2)
    assert new[[0, -1]] == pytest.approx(path[[0, -1]])
    assert (new >= path.min(axis=0) - 1e-9).all()
    assert (new <= path.max(axis=0) + 1e-9).all()


@settings(deadline=None, max_examples=50)
@given(instants, numbers, numbers)
def test_resampling_reproduces_linear_motion(time, start, speed) -> None:
    new = resampled(time, start + speed * time[:, None], 50)
    wanted = start + speed * np.linspace(0, time[-1], 50)
    assert new[:, 0] == pytest.approx(wanted, abs=1e-9 * (1 + abs(start) + abs(speed) * time[-1]))


ROWS = [f"{2 + 0.1 * k:.1f},{k},{2 * k}" for k in range(10)]
WANTED = np.column_stack([np.arange(10), 2 * np.arange(10)])


def write(folder: Path, rows: list[str], header: str = "time,x,y\n") -> str:
    (folder / "path.csv").write_text(header + "\n".join(rows) + "\n")
    return str(folder / "path.csv")


@pytest.mark.parametrize("header", ["time,x,y\n", "Time, X, Y\n", ""])
@pytest.mark.parametrize(("unit", "factor"), [("m", 1), ("cm", 0.01), ("mm", 0.001), ("inch", 0.0254)])
def test_lengths_arrive_in_metres_and_time_starts_at_zero(
    tmp_path: Path, header: str, unit: str, factor: float
) -> None:
    time, position = read_path(write(tmp_path, ROWS, header), Format(unit), axes=2)
    assert time == pytest.approx(np.arange(10) * 0.1)
    assert position == pytest.approx(factor * WANTED)


def rows(form: str) -> str:
    return "\n".join(form.format(t=f"{2 + 0.1 * k:.1f}", x=f"{k}.0", y=f"{2 * k}.0") for k in range(10)) + "\n"


PLAIN = rows("{t},{x},{y}")
COMMAS = rows("{t};{x};{y}").replace(".", ",")


@pytest.mark.parametrize(
    "text",
    [
        "# time,x,y\n" + rows("{t} {x} {y}"),
        "% recorded by hand\n%time,x,y\n" + PLAIN,
        "// t;x;y\n" + COMMAS,
        "sep=;\ntime;x;y\n" + COMMAS,
        "Subject 2, Trial 1\n; exported\ntime,x,y\n" + PLAIN,
        ",,\n,,\n,time,x,y\n" + rows(",{t},{x},{y}"),
        "Datum;Zeit;X;Y\n" + "".join(f"28.11.2026;{row}\n" for row in COMMAS.splitlines()),
        "time,x_m_smooth,y_m_smooth\n" + PLAIN.replace(",0.0", ",\u22120.0"),
        "TIME(S);X(M);Y(M)\r" + COMMAS.replace("\n", "\r"),
        rows("{t}\t{x}\t{y}").replace(".", ","),
        rows("{t} {x}  {y}").replace(".", ","),
        'time,x,y\n' + rows('"{t}","{x}","{y}"'),
        'time,x,y\n' + rows('"{t}","{x}","{y}"').replace(".", ","),
        "t,x,y\n" + PLAIN,
        "time [s],x [m],y [m]\n" + PLAIN,
        "Timestamp (s); X (m); Y (m)\n" + COMMAS,
        "time_s,x_m,y_m\n" + PLAIN,
        "time [s] x [m] y [m]\n" + rows("{t} {x} {y}"),
        "time,x,y\ns,m,m\n" + PLAIN,
        "y,x,time\n" + rows("{y},{x},{t}"),
        "%time,field.header.seq,field.header.stamp,field.pose.position.x,field.pose.position.y,field.pose.position.z,"
        "field.pose.orientation.x,field.pose.orientation.y\n" + rows("{t},7,9,{x},{y},1,1,1"),
        "pos_x,pos_y,vel_x,vel_y,time\n" + rows("{x},{y},5,5,{t}"),
        "time,x,y,,\n" + rows("{t},{x},{y},,"),
        "time,x,y\n\n" + PLAIN + ",,\n,,\n\n",
        "time,x,y\n" + PLAIN.replace("\n2.5", "\n,,\n# a break\n2.5"),
        "\n\ntime,x,y\r\n" + PLAIN.replace("\n", "\r\n"),
        "id,time,x,y,comment\n" + rows("a,{t},{x},{y},fine"),
        rows("+{t}e0,{x},{y}"),
        "Format Version,1.23,Rate,120.000,Exported,2\n\n,,pen,pen\nFrame,Time (Seconds),X,Y\n" + rows("7,{t},{x},{y}"),
        "Format Version,1.23,Rate,120.000,Exported,2\n\n,,pen,pen,pen\n,,1,1,1\n,,Position,Position,Position\n"
        "Frame,Time (Seconds),X,Y,Z\n" + rows("7,{t},{x},{y},5"),
        ",,Rotation,Rotation,Rotation,Position,Position,Error\nFrame,Time,X,Y,Z,X,Y,\n" + rows("7,{t},5,5,5,{x},{y},1"),
        ",Velocity (m/s),,Position (m),\nt,x,y,x,y\n" + rows("{t},5,5,{x},{y}"),
        "Lab 5, position of pen, Ann\ntime,x,y\n" + PLAIN,
        "time,center of gravity x (m),CentreOfGravityY (m),gravity x,gravity y\n" + rows("{t},{x},{y},0,9"),
        "velocity,,\nforce,5,\ntime,x,y\n" + PLAIN,
        ",Position,\ns,m,m\ntime,x,y\n" + PLAIN,
        "LabVIEW Measurement\nDate\t2024/05/01\t2024/05/01\t2024/05/01\nX_Dimension\tTime\tTime\tTime\n"
        "X0\t0.0\t0.0\t0.0\nDelta_X\t0.1\t0.1\t0.1\n***End_of_Header***\n\ntime\tx\ty\tz\n" + rows("{t}\t{x}\t{y}\t5"),
        ",time,x,y\n" + rows("7,{t},{x},{y}"),
        "time,x,y\n" + rows("0 days 00:00:0{t}00000,{x},{y}"),
        "time,x,y\n" + rows("1 days 00:00:0{t},{x},{y}"),
        "time,x,y\n" + rows("{t},{x},{y} # fine, too"),
        "time,note,x,y\n" + rows("{t},trial 5 #3,{x},{y}"),
        rows("{t} {x} {y} // fine"),
        rows("{t},{x},{y}").replace("\n2.5", " # the pen rests\n2.5") + "# the end\n",
        "elapsed,time,x,y\n" + rows("7,{t},{x},{y}"),
        "datetime,x,y\n" + rows("2026-11-28 10:00:0{t},{x},{y}"),
        "time,px,py,vx,vy\n" + rows("{t},{x},{y},5,5"),
        "time,px,py,x,y\n" + rows("{t},5,5,{x},{y}"),
        "Time,PosX,PosY,VelX,VelY\n" + rows("{t},{x},{y},5,5"),
        '"time,x,y"\n' + rows('"{t},{x},{y}"'),
        "time;x;y\n" + rows('"{t};{x};{y}"').replace(".", ","),
        "'time','x','y'\n" + rows("'{t}','{x}','{y}'"),
        '"time, s","x, m","y, m"\n' + PLAIN,
        "time (in s),x (in m),y (in m)\n" + PLAIN,
        "time,x,y\n" + PLAIN.replace("\n2.5", "\ntime,x,y\n2.5"),
        "Length Units,Meters\ntime,x,y\n" + PLAIN,
        "time,x,y,picture\n" + rows("{t},{x},{y}," + "QUJD" * 50_000),
        "# columns: x y t z\n" + rows("{x} {y} {t} 5"),
        "# Format: x y t\n" + rows("{x} {y} {t}"),
        "Order = x y t\n" + rows("{x},{y},{t}"),
        "! x y t\n" + rows("{x} {y} {t}"),
        "-- x y t\n" + rows("{x} {y} {t}"),
        "REM x y t\n" + rows("{x} {y} {t}"),
        "x y t # by hand\n" + rows("{x} {y} {t}"),
        '"x" "y" "elapsed time"\n' + rows("{x} {y} {t}"),
        "t x y note\n" + rows("{t} {x} {y} of trial 5"),
        "# [x, y, t]\n" + rows("{x},{y},{t}"),
        "# (x y t)\n" + rows("{x} {y} {t}"),
        "# xpos ypos time\n" + rows("{x} {y} {t}"),
        "# x-position, y-position and time\n" + rows("{x} {y} {t}"),
        "# x y t\n# the time series of x and y\n" + rows("{x} {y} {t}"),
        *(
            f"# {prose}\n" + PLAIN
            for prose in (
                "recorded by Ann", "Ann, lab 2, right hand", "sampled over time", "time in s", "Time: 10:05 UTC",
                "y is up", "x to right, y up, Ann", "T = 3", "1, 2, 3", "time", "28.11.2026, t, lab",
            )
        ),
        "time,time since start,x,y\n" + rows("{t},5,{x},{y}"),
        "time,goal position x,goal position y,x,y\n" + rows("{t},5,5,{x},{y}"),
        "time,x [m],x goal [m],y [m],y goal [m]\n" + rows("{t},{x},5,{y},5"),
        "s,m,m\n\ntime,x,y\n" + PLAIN,
        "# s,m,m\n" + PLAIN,
        "t (in s) x (in m) y (in m)\n" + rows("{t} {x} {y}"),
        "seconds,x,y\n" + PLAIN,
        "time,mm x,position x,y\n" + rows("{t},5,{x},{y}"),
        "time,x,y,angle [deg]\n" + rows("{t},{x},{y},5"),
        "Frame#,Time,X,Y\n" + rows("7,{t},{x},{y}"),
        '"time\n[s]","x\n[m]","y\n[m]"\n' + PLAIN,
        '"time\r\n[s]";"x\r\n[m]";"y\r\n[m]"\r\n' + COMMAS,
        "note,time,x,y\n" + rows('"a\n\nb",{t},{x},{y}'),
        'a screen of 5"\ntime,x,y\n' + PLAIN,
        "Zeitstempel;x;y\n" + COMMAS,
        "systime,x,y\n" + PLAIN,
        *(
            f"{name},x,y\n" + "".join(f"{(20 + k) * step},{k},{2 * k}\n" for k in range(10))
            for name, step in {"millis": 100, "ms": 100, "micros": 100_000, "nsecs": 100_000_000}.items()
        ),
        "# X-Achse, Y-Achse, Zeitpunkt\n" + rows("{x},{y},{t}"),
        "# timestamp tx ty tz qx qy qz qw\n" + rows("{t} {x} {y} 5 0 0 0 1"),
        "#timestamp [s], p_RS_R_x [m], p_RS_R_y [m], q_RS_x [], v_RS_R_x [m s^-1], b_w_RS_S_x [rad s^-1]\n"
        + rows("{t},{x},{y},0,5,5"),
        "Time,Hand-Joint-Posi-x,Hand-Joint-Posi-y,Hand-Joint-Velo-x,Hand-Joint-Velo-y\n" + rows("{t},{x},{y},5,5"),
        "time,current position x,current position y\n" + PLAIN,
        "time,current_x,current_y\ns,m,m\n" + PLAIN,
        "time,forceps_x,forceps_y\n" + PLAIN,
        "time,x,y\n" + PLAIN.replace(",0.0", ",\u20130.0").replace("\n2.5", "\n\ufeff2.5"),
        "Time,x,y\n" + rows("{t} sec,{x},{y}"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_files_of_many_makes_hold_the_same_path(tmp_path: Path, text: str, encoding: str) -> None:
    (tmp_path / "path.csv").write_bytes(text.encode(encoding))
    time, position = read_path(str(tmp_path / "path.csv"), axes=2)
    assert time == pytest.approx(np.arange(10) * 0.1)
    assert position == pytest.approx(WANTED)


@pytest.mark.parametrize("header", ["time{0}x{0}y\n", "timestamp (UTC){0}x{0}y\n", ""])
@pytest.mark.parametrize(("separator", "mark"), [(",", "."), (";", ","), ("\t", ".")])
@pytest.mark.parametrize(
    "form",
    [
        "2026-11-28T10:59:{:09.6f}+01:00",
        "2026-11-28 23:59:{:06.3f}Z",
        "2026-11-28 09:59:{:04.1f}",
        "9:59:{:04.1f}",
        "2026/11/28 23:59:{:06.3f}",
        "59:{:04.1f}",
        "159:{:04.1f}",
    ],
)
def test_dates_and_clocks_are_times(tmp_path: Path, form: str, separator: str, mark: str, header: str) -> None:
    data = [separator.join((form.format(50 + 0.1 * k), f"{k}{mark}0", f"{2 * k}{mark}0")) for k in range(10)]
    file = write(tmp_path, data, header.format(separator))
    time, position = read_path(file, axes=2)
    assert time == pytest.approx(np.arange(10) * 0.1, abs=1e-6)
    assert position == pytest.approx(WANTED)
    with pytest.raises(ValueError, match="its times are a clock's; leave out time_unit=ms"):
        read_path(file, Format(time_unit="ms"), axes=2)


@pytest.mark.parametrize("form", ["{:%H:%M:%S.%f}", "{:%M:%S.%f}"])
def test_a_clock_goes_on_behind_midnight_and_the_full_hour(tmp_path: Path, form: str) -> None:
    clock = [datetime(2026, 12, 31, 23, 59, 59, 100000) + timedelta(seconds=0.25 * k) for k in range(10)]
    file = write(tmp_path, [f"{form.format(now)},{k},0" for k, now in enumerate(clock)], "time,x,y\n")
    assert read_path(file, axes=2)[0] == pytest.approx(np.arange(10) * 0.25)


@pytest.mark.parametrize(
    ("header", "style", "factor", "second"),
    [
        ("time [ms],x [mm],y [mm]", Format(), 1e-3, 1e-3),
        ("time,x [inch],y [in]", None, None, None),
        ("time,x [inch],y [inch]", Format(time_unit="ms"), 0.0254, 1e-3),
        ("t_ms,x_cm,y_cm", Format("cm", "ms"), 1e-2, 1e-3),
        ("t_ms,x_cm,y_cm", Format(), 1e-2, 1e-3),
        ("t_min,x_cm,y_cm", Format(), 1e-2, 60),
        ("time in minutes,x in mm,y in mm", Format(), 1e-3, 60),
        ("time [milliseconds],x [millimeters],y [millimeters]", Format(), 1e-3, 1e-3),
        ("time,x,y\n[ms],[mm],[mm]", Format(), 1e-3, 1e-3),
        ("ms,mm,mm\nnote\ntime,x,y", Format(), 1e-3, 1e-3),
        ("[ms] [mm] [mm]\ntime x y", Format(), 1e-3, 1e-3),
        ("# ms,mm,mm", Format(), 1e-3, 1e-3),
        ("time in s,x in millimeter,y in millimeter", Format(), 1e-3, 1),
        ("Zeit in Sekunden,x in Millimetern,y in Millimetern", Format(), 1e-3, 1),
        ("time,x_in_world,y_in_world", Format("m", "s"), 1, 1),
        ("t_s,tool_in_base.x,tool_in_base.y", Format("cm"), 1e-2, 1),
        ("time (second),x [meter],y [meter]", Format(), 1, 1),
        ("time,x,y\nseconds,centimeters,centimeters", Format(), 1e-2, 1),
        ("time,x,y", Format("mm", "ms"), 1e-3, 1e-3),
        ("time,x [px],y [px]", Format("mm", "s"), 1e-3, 1.0),
    ],
)
def test_units_come_from_the_header_or_from_who_knows_better(
    tmp_path: Path, header: str, style: Format | None, factor: float, second: float
) -> None:
    file = write(tmp_path, [f"{100 * k},{k},{2 * k}" for k in range(10)], header + "\n")
    if style is None:
        with pytest.raises(ValueError, match="its header gives x, y in inch, in"):
            read_path(file, axes=2)
        return
    time, position = read_path(file, style, axes=2)
    assert time[-1] == pytest.approx(900 * second)
    assert position[-1] == pytest.approx([9 * factor, 18 * factor])


@pytest.mark.parametrize(
    ("header", "style", "sentence"),
    [
        ("time,x [px],y [px]", Format(), "its header gives x in px; set unit= to m, cm, mm, inch"),
        ("time,x [mm],y [mm]", Format("cm"), "its header gives x in mm, not in cm; set unit=mm"),
        ("time,x_px,y_px", Format(), "its header gives x in px; set unit= to m, cm, mm, inch"),
        ("time,pixelX,pixelY", Format(), "its header gives x in pixel; set unit= to m, cm, mm, inch"),
        ("time,x_µm,y_µm", Format(), "its header gives x in µm; convert it to one of m, cm, mm, inch"),
        ("time,x [dm],y [dm]", Format("cm"), "its header gives x in dm; convert it to one of m, cm, mm, inch"),
        ("time,x [0.1 mm],y [0.1 mm]", Format("mm"), "its header gives x in 0.1 mm; convert it to one of m, cm"),
        ("time,x_norm,y_norm", Format(), "its header gives x in norm; convert it to one of m, cm, mm, inch"),
        ("time,x [mm/s],y [mm/s]", Format("mm"), "its header gives x in mm/s, which is no length; give positions"),
        ("time,x [N],y [N]", Format(), "its header gives x in n, which is no length; give positions"),
        ("t_µs,x,y [mm]", Format(), "its header gives x, y in no unit, mm; give all in one unit"),
        ("time,x_deg,y_deg", Format(), "its header gives x in deg, which is no length; give positions"),
        ("time,twist.linear.x,twist.linear.y", Format(), "its columns are time, twist.linear.x, twist.linear.y; they"),
        ("time,accX,accY", Format(), "its columns are time, accX, accY; they must be time, x, y"),
        (",x,y", Format(), "its columns are .no name., x, y; they must be time, x, y"),
        ("# all in mm\ntime,x,y", Format(), "line 1 says 'in mm', .* set unit=mm if .* else unit=m"),
        ("Length Units,Millimeters\ntime,x,y", Format(), "line 1 says 'units,millimeters', .* set unit=mm if"),
        ("# in pixels\ntime,x,y", Format(), "'in pixels', .*; convert to one of m, cm, mm, inch and set unit= if"),
        ("# in degrees\ntime,x,y", Format(), "line 1 says 'in degrees', .*; give positions if .* else unit=m"),
        ("# in hours\ntime,x,y", Format(), "'in hours', .*; convert to one of s, ms, us, ns, min and set time_unit="),
        (
            "# time in ms\ntime,x [mm],y [mm]",
            Format(),
            "line 1 says 'in ms', .* set time_unit=ms if .* else time_unit=s",
        ),
        ("# time,x,y [px]\n", Format(), "its header gives x, y in no unit, px"),
        ("time [h],x,y", Format(), "its header gives time in h; convert it to one of s, ms, us, ns, min"),
        ("time,x1,y1", Format(), "its columns are time, x1, y1; they must be time, x, y"),
        ("Frame,X,Y\n,mm,mm", Format(), "its columns are Frame, X, Y; they must be time, x, y"),
        (
            ",Rotation,Rotation\ntime,x,y",
            Format(),
            "its columns are time, Rotation x, Rotation y; they must be time, x, y",
        ),
        (",Rotation,Rotation\n,pen,pen\ntime,x,y", Format(), "its columns are time, Rotation x, Rotation y; they must"),
        (",Position,\ns,mm,mm\ntime,x,y", Format("cm"), "its header gives x in mm, not in cm; set unit=mm"),
        (",Force,\ntime,x,y", Format(), "its columns are time, Force x, Force y; they must be time, x, y"),
        (",Position [mm],\ntime,x,y", Format("cm"), "its header gives x in mm, not in cm; set unit=mm"),
        (",L,L,R,R\ntime,x,y,x,y", Format(), r"its columns x and x .columns 2 and 4. could both be x; rename one"),
        *(
            (f"time,{names}", Format(), f"its columns are time, {names.replace(',', ', ')}; they must be time, x, y")
            for names in (
                "F_x,F_y,T_x,T_y",
                "M_x,M_y",
                "tau_x,tau_y",
                "B_x,B_y",
                "forces_x,forces_y",
                "ori_x,ori_y",
                "velocities x,velocities y",
                "gravity.x,gravity.y",
                "v center of gravity x,v center of gravity y",
                "accelerometerX,accelerometerY",
                "Sensor-Acce-x,Sensor-Acce-y",
                "tx,ty",
                "Kraft x,Kraft y",
            )
        ),
        ("Frame,Sub Frame,TX,TY\n,,mm,mm", Format(), "its columns are Frame, Sub Frame, TX, TY; they must be time, x"),
        ("TIME_STAMP,2019-11-05,6634.79\nMARKER_NAMES,pen", Format(), "its columns are MARKER_NAMES, pen; they must"),
        ("time\tx y", Format(), "its columns are time, x y; they must be time, x, y"),
        (
            "time,left.x,right.x,y",
            Format(),
            r"its columns left.x and right.x .columns 2 and 3. could both be x; rename one",
        ),
        ("time,wrist x,hand tip x,y", Format(), r"its columns wrist x and hand tip x .* could both be x; rename one"),
        ("time,goal_x,x_tip_now,y", Format(), r"its columns goal_x and x_tip_now .* could both be x; rename one"),
        ("sec,nanosec,x,y", Format(), "its time is split into sec and nanosec .columns 1 and 2.; give it in one col"),
        ("x,y,nsecs,secs", Format(), "its time is split into secs and nsecs .columns 4 and 3.; give it in one column"),
        *(
            (f"# {names}", Format(), f"its columns are {names}; they must be time, x, y")
            for names in ("time, vx, vy", "time, q1, q2", "t, lon, lat", "x, y, frame")
        ),
        (
            "# time [s], shoulder [rad], elbow [rad]",
            Format(),
            r"its columns are time.s., shoulder.rad., elbow.rad.; they",
        ),
        *(
            (
                f"time,{name}_x,{name}_y",
                Format(),
                f"its column {name}_x may be no place; name it x if it is one, or add",
            )
            for name in ("axis", "current", "motor", "joystick", "pressure")
        ),
        (
            "time,hand_x,elbow_y",
            Format(),
            "its columns hand_x and elbow_y seem to be of several places; name .* one x, y$",
        ),
        ("time,current_x [A],current_y [A]", Format(), "its header gives x in a, which is no length; give positions"),
        ("time,fx,fy,tx,ty,qx", Format(), "its columns are time, fx, fy, tx, ty, qx; they must be time, x, y$"),
        ("Frame,X,Y", Format(), "they must be time, x, y; name the time so, or add it .frame / frame rate"),
        ("time [mm:ss],x,y", Format(), "its header gives time in mm:ss; write its times as 2026-.* or 00:00.25"),
        ("sec,usec,x,y", Format(), "its time is split into sec and usec .columns 1 and 2.; give it in one column"),
        ("millis,x,y", Format(time_unit="s"), "its header gives time in ms, not in s; set time_unit=ms"),
        ("# t u v", Format(), "its columns are t, u, v; they must be time, x, y"),
        (
            "stamp.sec,stamp.nanosec,x,y",
            Format(),
            "its time is split into stamp.sec and stamp.nanosec .columns 1 and 2.",
        ),
    ],
)
def test_a_header_that_leaves_a_doubt_gets_one_sentence(
    tmp_path: Path, header: str, style: Format, sentence: str
) -> None:
    rows = [f"{0.1 * k},{k},{2 * k}" + ",0" * (header.splitlines()[-1].count(",") - 2) for k in range(10)]
    with pytest.raises(ValueError, match=sentence):
        read_path(write(tmp_path, rows, header + "\n"), style, axes=2)


def rested(pause: float) -> list[float]:
    """Two strokes of 200 samples in 0.995 s each, and a pause [s] between."""
    return [*(0.005 * np.arange(200)), *(0.995 + pause + 0.005 * np.arange(200))]


@pytest.mark.parametrize(
    ("stamps", "sentence"),
    [
        ([0, *(2233.5 + 0.05 * np.arange(59))], "line 3 comes 2233.5 s after the line before, where the usual step is"),
        ([*(0.05 * np.arange(30)), *(9 + 0.05 * np.arange(30))], "line 32 comes 7.55 s after .* set time_unit="),
        (rested(1.15), "line 202 comes 1.15 s after .* delete what"),  # more than a third of the time
        (50.0 * np.arange(60), "line 3 comes 50 s after the line before, and all take 2950 s; set time_unit=ms if"),
        (1.7e18 + 5e7 * np.arange(60), "set time_unit=ns if that is the unit of its stamps, time_unit=s if it is"),
        (1.7e15 + 5e4 * np.arange(60), "set time_unit=us if that"),
        (1200.0 * np.arange(60), "set time_unit=us if that"),
        (900.0 * np.arange(60), "set time_unit=ms if that"),
        (np.arange(100), "line 3 comes 1 s after the line before, and all take 99 s; set time_unit=ms"),
        (1e-6 * np.arange(60), "it lasts 5.9e-05 s from line 2 to 61; its unit of time must be another"),
    ],
)  # fmt: skip
def test_stamps_that_are_no_seconds_of_one_movement_get_one_sentence(tmp_path: Path, stamps, sentence: str) -> None:
    file = write(tmp_path, [f"{t!r},{k},0" for k, t in enumerate(map(float, stamps))])
    with pytest.raises(ValueError, match=sentence):
        read_path(file, axes=2)


@pytest.mark.parametrize(
    "stamps",
    [
        1.7e9 + 0.05 * np.arange(60),  # since 1970
        np.cumsum(np.tile([0.001, 0.05], 30)),  # in pairs, as networks deliver
        rested(0.85),  # the pen rests for a while, 30 % of the time
        5.0 * np.arange(10),  # ten places of a slow task
    ],
)
def test_unequal_steps_and_far_stamps_are_read(tmp_path: Path, stamps) -> None:
    file = write(tmp_path, [f"{t:.6f},{k},0" for k, t in enumerate(stamps)])
    assert read_path(file, axes=2)[0][-1] == pytest.approx(stamps[-1] - stamps[0], abs=1e-5)
    assert read_path(write(tmp_path, [f"{50 * k},{k},0" for k in range(60)]), Format(time_unit="s"), 2)[0][-1] == 2950


def test_samples_of_one_instant_are_dropped_on_request(tmp_path: Path) -> None:
    file = write(tmp_path, [*ROWS[:4], ROWS[3].replace(",3,", ",9,"), *ROWS[4:]])
    with pytest.raises(ValueError, match=r"not increase at line 6 \(duplicates=drop keeps the first"):
        read_path(file, axes=2)
    assert read_path(file, Format(duplicates="drop"), axes=2)[1] == pytest.approx(WANTED)
    with pytest.raises(ValueError, match=r"not increase at line 6$"):
        read_path(write(tmp_path, [*ROWS[:5], ROWS[2], *ROWS[5:]][1:]), Format(duplicates="drop"), axes=2)


def test_a_file_in_eight_bits_is_read_when_its_encoding_is_named(tmp_path: Path) -> None:
    (tmp_path / "path.csv").write_bytes(("# größe\n" + "\n".join(ROWS)).encode("latin-1"))
    with pytest.raises(
        ValueError, match=r"cannot read .*path.csv': line 1 is not UTF-8; save it as UTF-8 or name its enc"
    ):
        read_path(str(tmp_path / "path.csv"), axes=2)
    assert read_path(str(tmp_path / "path.csv"), Format(encoding="cp1252"), 2)[1] == pytest.approx(WANTED)
    assert read_path(str(tmp_path / "path.csv"), Format(encoding=1252), 2)[1] == pytest.approx(WANTED)
    with pytest.raises(ValueError, match="encoding = latin-17 is not allowed"):
        read_path(str(tmp_path / "path.csv"), Format(encoding="latin-17"), 2)
    with pytest.raises(ValueError, match="encoding = cp5 is not allowed: it must be a name such as utf-8 or cp1252"):
        read_path(str(tmp_path / "path.csv"), Format(encoding=5), 2)
    with pytest.raises(ValueError, match=r"encoding = \['utf-8'\] is not allowed: it must be a name such as utf-8"):
        Format(encoding=["utf-8"])


def test_a_million_rows_are_not_read_row_by_row_which_takes_numpys_time_fifty_fold(tmp_path: Path) -> None:
    rows = [f"{k / 1000},{k},0.5" for k in range(1_000_000)]
    (tmp_path / "long.csv").write_text("\n".join(["time,x,y", *rows, ",,", ""]))
    start = process_time()
    np.loadtxt(rows, delimiter=",")
    between = process_time()
    time, position = read_path(str(tmp_path / "long.csv"), axes=2)
    assert process_time() - between < 10 * (between - start)
    assert len(position) == len(time) == 1_000_000


def test_a_row_is_named_by_its_line_where_rows_are_read_one_by_one(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="does not increase at line 7"):
        read_path(write(tmp_path, [f"{ROWS[0]},", *ROWS[1:5], ",,", ROWS[4], *ROWS[6:]], header=""), axes=2)


def test_a_place_goes_before_others_of_as_many_words(tmp_path: Path) -> None:
    rows = [row.replace(",", ",0,", 1) for row in ROWS]
    path = write(tmp_path, rows, "time,target x,position x,y\n")
    assert read_path(path, axes=2)[1][:, 0] == pytest.approx(WANTED[:, 0])


@pytest.mark.parametrize(
    ("rows", "header", "sentence"),
    [
        (
            [*ROWS[:4], "2.4,nan,1", *ROWS[5:]],
            "time,x,y\n",
            "line 6 holds '2.4,nan,1': every entry must be a fin",
        ),
        ([], "\n\n", "it is empty"),
        (
            ['{"time": 1, "x": 2, "y": 3}'],
            "",
            "it is JSON or a printed list, not columns of numbers; export them as CSV",
        ),
        (["[[0.0 1.0 2.0]", "[0.1 1.0 2.0]]"], "", "it is JSON or a printed list"),
        (["<path>", "<p t='0' x='1' y='2'/>"], "", "it is XML, not columns"),
        (["0.0,,", *ROWS], "", "line 1 holds '0.0,,': it must have time, x, y, or name the columns"),
        (
            [row.replace(",", " mm,") for row in ROWS],
            "time,x,y\n",
            "line 2 holds .*every entry must be a finite number",
        ),
        ([*ROWS[:4], "2.4,one,1", *ROWS[5:]], "", "line 5 holds '2.4,one,1'"),
        ([*ROWS[:4], "2.4,,1", *ROWS[5:]], "time,x,y\n", "line 6 holds '2.4,,1'"),
        ([*ROWS[:4], "2.4,3", *ROWS[5:]], "time,x,y\n", "line 6 holds '2.4,3'"),
        ([*ROWS[:4], "2.4,3", *ROWS[5:]], "", "line 5 has 2 numbers"),
        ([*ROWS[:4], ROWS[3], *ROWS[5:]], "time,x,y\n", "does not increase at line 6"),
        ([*ROWS, "time,y,x", *ROWS], "time,x,y\n", "line 12 holds 'time,y,x': give each of several recordings a"),
        (["- [0, 1, 2]"] * 9, "data:\n", "it is YAML, not columns of numbers"),
        (["header:\n  seq: 1\nx: 1\n---"] * 9, "", "it is YAML, not columns of numbers"),
        ([*ROWS, *ROWS], "time,x,y\n", "does not increase at line 12; give each of its recordings a file of its own"),
        (ROWS[:7], "time,x,y\n", "has 7 samples; there must be at least 8"),
        (["# x"], "", "has 0 samples"),
        ([], "time,x,y\n", "it has no row of numbers parted by commas, semicolons, tabs or blanks"),
        (["0.5|1|2"] * 9, "time|x|y\n", r"it has no row of numbers parted by .*; line 10 holds '0.5.1.2'"),
        *(
            ([f"{error},1,2"] * 9, "0,1,2\n1,1,3\n", f"line 3 holds '{error},1,2': every entry must be a finite number")
            for error in ("#N/A", "#NV", "#DIV/0!", "#ÜBERLAUF!", "#¡VALOR!")
        ),
        ([*ROWS[:4], '2.4,"a', 'b",1', ROWS[2], *ROWS[5:]], "time,x,y\n", "line 6 holds"),
        (['2.0,"0\n",1', *ROWS[1:4], ROWS[2], *ROWS[4:]], "time,x,y\n", "its time does not increase at line 7"),
        ([*ROWS[:4], "2.4,2e300,1", *ROWS[5:]], "time,x,y\n", r"line 6 is 2e\+300 m away; mend it, or set unit="),
        (
            [f"28.11.2026 10:00:0{k}.5,{k},1" for k in range(9)],
            "time,x,y\n",
            "line 2 holds .*all be as 2026-11-28T10:0",
        ),
        ([f"2026-02-31 10:00:0{k},{k},1" for k in range(9)], "time,x,y\n", "line 2 holds .*its time must be a number"),
        ([ROWS[0], *(f"10:00:0{k},{k},1" for k in range(9))], "time,x,y\n", "line 3 holds .*its time must be a number"),
        ([f"23:59:5{k + 6 if k < 4 else 0},{k},1" for k in range(9)], "time,x,y\n", "time does not increase at line 6"),
        (
            [f"2026-11-{28 - k // 4}T10:00:0{k},{k},1" for k in range(9)],
            "time,x,y\n",
            "time does not increase at line 6",
        ),
        (["2.0,NA,NA", *ROWS[1:]], "time,x,y\n", "line 2 holds '2.0,NA,NA': every entry must be a finite number"),
        (
            [f"10_59_5{k},{k},1" for k in range(9)],
            "time,x,y\n",
            "line 2 holds '10_59_50,0,1': every entry must be a fin",
        ),
        ([f"{k}.0D-1,1.0D0,1" for k in range(9)], "time,x,y\n", "line 2 holds '0.0D-1,"),
        (
            [f'"{k}",{row}' for k, row in enumerate(ROWS)],
            '"time","x","y"\n',
            "line 2 has 4 entries, but .* names 3 col",
        ),
        ([f"{k},05,1,5,2,0" for k in range(9)], "time,x,y\n", "line 2 has 6 entries, .* names 3 columns, .* or part"),
        *(
            ([row.replace(",", " ") for row in ROWS], header, f"line 2 has 3 entries, but the header names {count} col")
            for header, count in (
                ("elapsed time x y\n", 4),
                ("Time (s) Pos X (mm) Pos Y (mm)\n", 5),
                ("% data t x y\n", 4),
                ("Time s X mm Y mm\n", 6),
            )
        ),
        (
            [f'"{k}" {row.replace(",", " ")}' for k, row in enumerate(ROWS)],
            '"time" "x" "y"\n',
            "line 2 has 4 entries, but the header names 3 columns, time, x, y; name each column in one word",
        ),
        (
            [f"2024-01-01 10:00:0{k}.05 {k} 0" for k in range(9)],
            "time x y\n",
            "line 2 has 4 entries, but the header na",
        ),
        (
            [f"0.{k};1,{k}00;0.5" for k in range(1, 10)],
            "t;x;y\n",
            "line 2 holds .*either . or , and no mark between th",
        ),
        (
            [f"0,{k};1.{k}00,0;0,5" for k in range(1, 10)],
            "t;x;y\n",
            "line 2 holds .*either . or , and no mark between t",
        ),
        (ROWS, "0,1,2\n", "line 1 numbers the columns; delete it, or name them time, x, y"),
        (
            [*ROWS * 3, "0.1,1,2,3"],
            "time,x,y\n",
            "line 32 has 4 entries, but the header names 3 columns, time, x, y; .*",
        ),
        (ROWS, "# all lengths in millimeter\ntime,x,y\n", "line 1 says 'in millimeter', .*set unit=mm if that is"),
        (ROWS, "time,x,y\ns,px,px\n", "its header gives x in px; set unit= to m, cm, mm, inch"),
        (ROWS, "time,x [mm],y [cm]\n", "its header gives x, y in mm, cm; give all in one unit"),
        ([row + ",0" for row in ROWS], "", "line 1 has 4 numbers; it must have time, x, y"),
        ([f"{0.1 * k},1,2" for k in range(10)], "", "it never moves: all its samples are at one place"),
    ],
)
def test_a_file_that_cannot_be_used_gets_one_sentence(tmp_path: Path, rows, header: str, sentence: str) -> None:
    with pytest.raises(ValueError, match=f"path.csv': .*{sentence}"):
        read_path(write(tmp_path, rows, header), axes=2)


@pytest.mark.parametrize(
    ("rows", "header", "sentence"),
    [
        ([*ROWS, "a" * 200_000 + ",1,2"], "time,x,y\n", "line 12 holds 'aaaaa"),
        (ROWS, "time," + ",".join("abcdefgh" * 900) + "\n", "its columns are time, a, b"),
    ],
)
def test_a_sentence_shows_the_beginning_of_a_long_line(tmp_path: Path, rows, header: str, sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence) as caught:
        read_path(write(tmp_path, rows, header), axes=2)
    assert len(str(caught.value)) < 600


def test_a_file_or_unit_that_is_not_there_gets_one_sentence(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"cannot read 'no.csv': No such file"):
        read_path("no.csv")
    with pytest.raises(ValueError, match="unit = ft is not allowed: it must be one of m, cm, mm, inch"):
        read_path(write(tmp_path, ROWS), Format("ft"))


def test_what_is_no_text_is_said_to_be_none(tmp_path: Path) -> None:
    for begin in (
        b"PK\x03\x04\x14\0",
        b"\x1f\x8b\x08\0",
        b"BZh91AY&SY",
        b"\xfd7zXZ\0",
        b"7z\xbc\xaf'",
        b"\x28\xb5\x2f\xfd",
    ):
        (tmp_path / "path.csv").write_bytes(begin + bytes(range(256)))
        with pytest.raises(ValueError, match="it is a spreadsheet or an archive, not text; export or unpack it first"):
            read_path(str(tmp_path / "path.csv"))
    for start, sentence in {
        b"\x93NUMPY\x01": "a NumPy file, not text; export its numbers as CSV", b"MATLAB 5.0 MAT-": "a MATLAB file",
        b"\x89HDF\r\n": "an HDF5 file", b"\n<!DOCTYPE html>": "a web page; download the file itself",
        b"MATLAB 7.3 MAT-": "a MATLAB file", b"\x89MCAP0\r\n": "a ROS bag", b"\x89PNG\r\n\x1a\n": "a picture, not text",
        b"\xff\xd8\xff\xe0\0\x10JFIF": "a picture", b"%PDF-1.7\n%\xe2\xe3": "a PDF file", b"{\\rtf1": "an RTF file",
        b"SQLite format 3\0": "an SQLite file",
        b"0,1,2\n\x80\4": "no text, or damaged: line 2 holds the byte 04; save it as text",
        ("time,x,y\n" + PLAIN).replace("2.5,", "2.5\0,").encode(): "no text, or damaged: line 7 holds the byte 00",
        b"version https://git-lfs.github.com/spec/v1\n": "a pointer of Git LFS to the file; run: git lfs pull",
    }.items():  # fmt: skip
        (tmp_path / "path.csv").write_bytes(start)
        with pytest.raises(ValueError, match=f"cannot read '.*': it is {sentence}"):
            read_path(str(tmp_path / "path.csv"))


def test_several_files_take_turns(tmp_path: Path) -> None:
    for number in (1, 2):
        (tmp_path / f"{number}.csv").write_text("\n".join(f"{k},{number * k},0" for k in range(8)))
    paths = demonstrations(str(tmp_path / "*.csv"), 3, 20, Format("cm"), axes=2)
    assert [path[-1, 0] for path in paths] == pytest.approx([0.07, 0.14, 0.07])
    with pytest.raises(ValueError, match="2 files are more than the 1 demonstrations"):
        demonstrations(str(tmp_path / "*.csv"), 1, 20, Format(), axes=2)


def test_a_folder_is_answered_by_how_its_files_are_named(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"is a folder; give its files, such as .*/\*\.csv$"):
        demonstrations([str(tmp_path)], 1, 20, Format(), axes=2)


def test_a_name_may_begin_with_a_tilde_that_is_nobodys_home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "~t.csv").write_text("\n".join(ROWS))
    assert demonstrations("~t.csv", 1, 20, Format("cm"), axes=2)[0][-1] == pytest.approx([0.09, 0.18])
    with pytest.raises(ValueError, match=r"cannot read '~u.csv': No such file"):
        demonstrations("~u.csv", 1, 20, Format(), axes=2)


@pytest.mark.parametrize(
    "name", ["letter (1).csv", "Übung_größe.csv", "a=b.csv", "trial[1].csv", "Öl & Büro (neu)/#1.csv"]
)
def test_a_name_is_a_name_before_it_is_a_pattern(tmp_path: Path, name: str) -> None:
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_text("\n".join(ROWS))
    (path,) = demonstrations(str(tmp_path / name), 1, 20, Format("cm"), axes=2)
    assert path[-1] == pytest.approx([0.09, 0.18])


def test_a_path_that_no_hand_can_have_gone_is_read_with_a_warning(tmp_path: Path) -> None:
    pixels = write(tmp_path, [f"0.{k},{100 * k},{k}" for k in range(8)])
    with pytest.warns(UserWarning, match="path.csv' spans 7 m; set unit= if that is too large"):
        demonstrations(pixels, 1, 20, Format(), axes=2, otherwise="cm")


def test_a_path_in_metres_that_is_taken_for_one_in_centimetres_is_read_with_a_warning(tmp_path: Path) -> None:
    metres = write(tmp_path, [f"0.{k},{0.02 * k},{k % 2}e-2" for k in range(8)])
    with pytest.warns(UserWarning, match="path.csv' spans 0.0014 m; set unit= if that is too small"):
        demonstrations(metres, 1, 20, Format(), axes=2, otherwise="cm")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        demonstrations(metres, 1, 20, Format("cm"), axes=2, otherwise="cm")


@pytest.mark.parametrize("again", ["time,x,y", "\ntime,x,y\n", "# time,x,y"])
def test_two_recordings_in_one_file_are_read_with_warnings(tmp_path: Path, again: str) -> None:
    twice = [f"{0.1 * k:.1f},{k % 20},0" for k in range(40)]
    head = "# time,x,y\n" if "#" in again else "time,x,y\n"
    line, first = 22 + again.startswith("\n"), 22 + again.count("\n") + 1
    with (
        pytest.warns(
            UserWarning, match=f"names its columns again in line {line}; give each recording a file of its own"
        ),
        pytest.warns(UserWarning, match=f"jumps by 19 m from line 21 to {first}, and spans 19 m; delete what does not"),
    ):
        time, _ = read_path(write(tmp_path, [*twice[:20], again, *twice[20:]], head), axes=2)
    assert len(time) == 40
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read_path(write(tmp_path, [f"{0.1 * k:.1f},{k},0" for k in range(40)]), axes=2)


SQUARE = ["0,0", "4,0", "4,2", "0,2"]
AROUND = np.array([[0, 0], [4, 0], [4, 2], [0, 2]])


@pytest.mark.parametrize(
    ("header", "style", "otherwise", "factor"),
    [
        ("x,y\n", Format(), "m", 1),
        ("x,y\n", Format(), "cm", 0.01),
        ("x [mm],y [mm]\n", Format(), "cm", 0.001),
        ("x,y\n", Format("inch"), "cm", 0.0254),
        ("", Format(), "mm", 0.001),
    ],
)
@pytest.mark.parametrize("closing", [[], SQUARE[:1]])  # an outline may return to where it began
def test_corners_are_those_of_the_outline_in_order_and_in_metres(
    tmp_path: Path, header: str, style: Format, otherwise: str, factor: float, closing: list[str]
) -> None:
    corners = read_corners(write(tmp_path, SQUARE + closing, header), style, otherwise)
    assert corners == pytest.approx(factor * AROUND)


def test_a_corner_that_another_one_only_shares_a_coordinate_with_is_kept(tmp_path: Path) -> None:
    assert len(read_corners(write(tmp_path, ["0,0", "4,0", "4,2", "0,1"], "x,y\n"))) == 4
    assert len(read_corners(write(tmp_path, ["0,0", "4,0", "0,1"], "x,y\n"))) == 3


@pytest.mark.parametrize("rows", [["0,0", "1,1"], ["0,0", "1,1", "0,0"], ["0,0", "1,2", "2,4", "5,10"], ["1,1"], []])
def test_what_has_no_area_is_no_outline(tmp_path: Path, rows: list[str]) -> None:
    with pytest.raises(ValueError, match=r"path.csv': it has no "):
        read_corners(write(tmp_path, rows, "x,y\n"))


def test_a_corner_out_of_reach_is_named(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"path.csv': line 3 is 4e\+300 m away"):
        read_corners(write(tmp_path, ["0,0", "4e300,0", "0,1"], "x,y\n"))


def test_an_outline_in_metres_that_is_taken_for_one_in_centimetres_is_read_with_a_warning(tmp_path: Path) -> None:
    metres = write(tmp_path, ["0,0", "0.3,0", "0.3,0.2"], "x,y\n")
    with pytest.warns(UserWarning, match="path.csv' spans 0.003 m; set unit= if that is too small"):
        read_corners(metres, otherwise="cm")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read_corners(metres, Format("cm"))
        read_corners(metres, Format("m"), otherwise="cm")


def test_an_outline_that_is_not_there_is_named() -> None:
    with pytest.raises(ValueError, match=r"cannot read 'no.csv': No such file"):
        read_corners("no.csv")


def test_a_line_is_named_by_its_number_in_the_file_however_it_is_read(tmp_path: Path) -> None:
    """Line 7 goes back in time; the empty entries of line 4 let the file be read row by row."""
    for more in ([], [",,"]):
        found = [*ROWS[:2], *more, *ROWS[2:5], ROWS[1], *ROWS[5:]]
        with pytest.raises(ValueError, match=f"does not increase at line {7 + len(more)}$"):
            read_path(write(tmp_path, found), axes=2)


def test_whole_numbers_that_begin_by_counting_the_columns_are_samples(tmp_path: Path) -> None:
    time, position = read_path(write(tmp_path, [f"{k},{k + 1},{k + 2}" for k in range(9)], ""), axes=2)
    assert time == pytest.approx(np.arange(9))
    assert position[0] == pytest.approx([1, 2])


def test_one_row_is_too_few_and_said_so(tmp_path: Path) -> None:
    for header in ("time,x,y\n", ""):
        with pytest.raises(ValueError, match="it has 1 samples; there must be at least 8"):
            read_path(write(tmp_path, ROWS[:1], header), axes=2)


@pytest.mark.parametrize("spelt", ["min", "minutes"])
def test_units_of_time_are_those_of_the_header(tmp_path: Path, spelt: str) -> None:
    file = write(tmp_path, [f"{0.1 * k},{k},{2 * k}" for k in range(10)], f"time [{spelt}],x,y\n")
    assert read_path(file, axes=2)[0][-1] == pytest.approx(54)


def test_units_above_the_names_may_be_of_other_quantities_too(tmp_path: Path) -> None:
    file = write(tmp_path, [f"{0.1 * k},{k},{2 * k},5" for k in range(10)], "s,mm,mm,N\ntime,x,y,force\n")
    assert read_path(file, axes=2)[1][-1] == pytest.approx([0.009, 0.018])


def test_the_place_is_of_the_wanted_axes(tmp_path: Path) -> None:
    file = write(tmp_path, [f"{0.1 * k},{k},{2 * k},{3 * k}" for k in range(10)], "time,x,y,z\n")
    assert read_path(file)[1][-1] == pytest.approx([9, 18, 27])
    assert read_path(file, axes=2)[1][-1] == pytest.approx([9, 18])
