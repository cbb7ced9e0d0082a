"""A call of Python and a command line of the program make the same request and have the same results."""

import json
import os
import re
import subprocess
from pathlib import Path
from typing import Any

import commands
import funicular
import numpy as np
import pytest
from conftest import ROOT
from jsonschema import Draft202012Validator

# Lines for commands and options without an example in the help texts.
STATE = "--mass-kg 20 --force-n 1,0,-5 --moment-n-m 0,0.1,0 --load-point-m 0,0,0.1 --wind-m-s 5,0,0 --cable-load-n-per-m 0,0,-0.1"
LENGTHS = "--lengths-m 6.9,6.6,6.8,6.7,6.8,6.6"
MODEL = "--cable-model shallow-dynamic --assembly without-geometric-stiffness --in-plane-only --winches torque"
ROBOT = "robots/yuan2014-4mm.toml"
WHOLE = "--cable-model catenary-dynamic --assembly consistent"
RANGE = "--from-hz 0.5 --to-hz 8 --points 7"
TENSIONS = "--pose 1,2,1.5,0,3,10 --tension-rule closest --target-tension-n 900 --min-tension-n 5 --max-tension-n 4000"
GUSTY = (
    "robots/stadium-camera.toml --set materials.rope-5mm.drag_coefficient=1.2 --set materials.rope-5mm.drag_diameter_m=0.005 "
    "--wind-m-s 12,0,0 --turbulence kaimal --intensity 0.15,0.12,0.075 --length-scale-m 85,28,6.9"
)
REQUIRED = (
    "--required-force-n 20,20,20 --required-moment-n-m 2,2,2 --required-shape ellipsoid --required-wind-speed-m-s 5 "
    "--required-payload-min-kg 5 --required-payload-max-kg 40 --required-payload-center-m 0,0,0.1 "
    "--required-payload-center-reach-m 0.1,0.1,0 --required-acceleration-m-s2 1,1,1 "
    "--required-angular-acceleration-rad-s2 0.2,0.2,0.2"
)
COURSE = (
    "--course quintic --speed-m-s 1 --acceleration-m-s2 2 --jerk-m-s3 30 --angular-speed-rad-s 0.5 "
    "--angular-acceleration-rad-s2 1 --angular-jerk-rad-s3 9 --duration-s 6 --rope-inertia --sample-time-s 0.25 "
    "--station-time-s 0.1 --length-tolerance-m 1e-3"
)
CIRCLE = (
    "--speed-m-s 1 --acceleration-m-s2 1 --jerk-m-s3 10 --angular-speed-rad-s 1 --angular-acceleration-rad-s2 1 "
    "--angular-jerk-rad-s3 10 --sample-time-s 0.5"
)
VELOCITIES = "--required-velocity-shape ellipsoid --required-velocity-m-s 1,1,0.5 --required-angular-velocity-rad-s 0.2,0.2,0.2 --set winches.drum.max_speed_m_s=3"
LENGTHS_OVER_TIME = """t_s,unstrained_length_1_m,unstrained_length_2_m,unstrained_length_3_m,unstrained_length_4_m,unstrained_length_5_m,unstrained_length_6_m
0,6.86,6.568,6.753,6.666,6.801,6.604
0.5,6.862,6.566,6.755,6.664,6.801,6.604
1,6.863,6.565,6.756,6.663,6.801,6.604
"""
PROVED = "funicular prove robots/cogiro.toml --pose 0,0,1.5 --static-model spring --within-m 0.2,0.2,0.1"
ESTIMATED = "docs/estimation/robot.toml --log docs/estimation/run.csv"
MACHINE = "docs/calibration/machine.toml --readings docs/calibration/belts.csv"
MORE = [
    "funicular schema --of request",
    f"funicular statics {ROBOT} --all",
    f"funicular statics {ROBOT} {LENGTHS} {STATE}",
    f"funicular statics robots/cogiro.toml {TENSIONS} --mass-kg 300 --static-model spring",
    f"funicular stiffness {ROBOT} --at-hz 1.5 --pose 0,0,0.5 {STATE} {MODEL}",
    f"funicular modes {ROBOT} --below-hz 3 {LENGTHS} --input f:1,0,1 --output ay --input-point-m 0.1,0,0 --stations 5",
    f"funicular modes {ROBOT} --below-hz 3 --pose 0,0,0.5 {STATE} {MODEL} --input fz --output z --output-point-m 0,0,0.1",
    f"funicular frf {ROBOT} {RANGE} --log --input cable:3@0.5:fz --output vz --prominence-db 3 --pose 0,0,0.5 {STATE}",
    f"funicular frf {ROBOT} {RANGE} {MODEL} --input fz --output rx --input-point-m 0.1,0,0",
    f"funicular frf {ROBOT} --from-hz 0.5 --to-hz 2 --adaptive --input fz --input fx --output z --output rx",
    f"funicular settle {ROBOT} --release-n 0,0,-1 --below-hz 2 {LENGTHS} --input-point-m 0.1,0,0 --output-point-m 0,0,0.1",
    f"funicular settle robots/cogiro.toml --release-n-m 5,0,0 --tolerance-m 1e-5 --below-hz 5 {TENSIONS} --hold-lengths-of-pose",
    f"funicular settle {ROBOT} --stop-m-s 0,0.1,0 --stop-rad-s 0,0,0.1 --profile-s 0.5,0.1 --below-hz 3",
    f"funicular settle {ROBOT} --move-m 0,0.02,0 --move-deg 0,0,1 --profile-s 1,0.2 --below-hz 3 --shaper ei:0.05 --shape-modes-hz 1.02 --sample-time-s 0.1",
    f"funicular settle {ROBOT} --trajectory lengths.csv --below-hz 2 --robust-payload-kg 0.5,1",
    f"funicular settle {ROBOT} --release-n 0,0,-0.5 --pose 0,0,0.5 --below-hz 3 {STATE} {WHOLE} --winches clamped",
    f"funicular gust {GUSTY} --output z --output tension:2 --below-hz 1 --duration-s 300 --coherence-decay 3,8,8",
    f"funicular gust {GUSTY} --output x --output-point-m 0,0,0 --below-hz 1 --mass-kg 15",
    f"funicular gust {ROBOT} --set platform.drag_area_m2=0.1 --turbulence von-karman --intensity 0.1,0.1,0.1 "
    f"--length-scale-m 50,20,5 --below-hz 1 --output z --pose 0,0,0.5 {STATE} {WHOLE} --winches clamped",
    f"funicular gust robots/cogiro.toml --set platform.drag_area_m2=1 --wind-m-s 5,0,0 --turbulence kaimal "
    f"--intensity 0.1,0.1,0.1 --length-scale-m 50,20,5 --below-hz 1 --output z {TENSIONS} --hold-lengths-of-pose",
    f"funicular gust {ROBOT} --set platform.drag_area_m2=0.1 --wind-m-s 8,0,0 --spectrum gusts.csv --below-hz 1 --output z",
    f"funicular modes {ROBOT} --below-hz 2 --decay-percent 10",
    "funicular clearance windy.toml --in-gusts",
    f"funicular simulate {ROBOT} --mass-kg 12.5 --scenario docs/simulation/release.toml --duration-s 0.05 --sample-time-s 0.01 --tolerance-m 1e-6 --elements 2 --degree 6 --damping-frequency-hz 1.2 --point hook=0,0,-0.5 --point edge=0.1,0,0",
    f"funicular simulate {ROBOT} --duration-s 0.01 --once --pose 0,0,0.5 {STATE}",
    f"funicular simulate robots/cogiro.toml --duration-s 0.01 --once {TENSIONS} --hold-lengths-of-pose",
    f"funicular simulate {ROBOT} --duration-s 0.01 --once {LENGTHS}",
    f"funicular simulate {ROBOT} --duration-s 0.02 --once --stretch-damping-time-s 1e-4 --hold-platform",
    "funicular simulate windy.toml --duration-s 0.02 --once --gust-seed 1",
    f"funicular calibrate {MACHINE} --unknowns anchors --hold-anchors bl,br --leave-out 2,5 --starts 3 --position-std-m 0.01 --rotation-std-deg 0.5 --tension-std-n 2",
    f"funicular calibrate {MACHINE} --prior cables.tl.anchor_m=±0.05 --prior cables.tr.anchor_m.y=3.8±0.1 --profile anchors",
    "funicular calibrate robots/ipanema2.toml --readings docs/tutorials/ipanema-lengths.csv --static-model spring --tension-range-n 200:2000",
    f"funicular calibrate {MACHINE} --propose 1 --grid x=1:3:3 --propose-by determinant --min-tension-n 5 --max-tension-n 50 --tension-rule closest --target-tension-n 20",
    f"funicular calibrate {MACHINE} --length-std-m 0.0005 --propose 1 --poses waypoints.csv --propose-for anchors --wanted-std-m 0.05",
    f"funicular estimate {ESTIMATED} --every-s 0.5 --inertial-unit-m 0.1,0,0.5 --tracked-point-m 0,0,1 --near-pose 0,0,1.5 --false-alarms-per-hour 1 --length-std-m 1e-5 --tension-std-n 4",
    f"funicular estimate {ESTIMATED} --every-s 1 --cable-angle-std-rad 0.002 --gyroscope-std-rad-s 0.003 --accelerometer-std-m-s2 0.05 --tracker-std-m 0.002 --payload-kg 1 --payload-std-kg 0.5",
    f"funicular estimate {ESTIMATED} --every-s 1 --first-moment-std-kg-m 0.05 --force-std-n 2 --moment-std-n-m 0.4 --force-time-s 2 --offset-std-m 0.002 --tension-bias-std-n 6 --friction 0.01",
    f"funicular observability docs/estimation/robot.toml --sensors tensions,tracker --further-pose-m 0.2 --inertial-unit-m 0.1,0,0.5 --tracked-point-m 0,0,1 --length-std-m 1e-5 {TENSIONS}",
    "funicular observability docs/estimation/robot.toml --sensors none --grid x=-0.5:0.5:2 --grid z=1.5 --tension-std-n 4 --cable-angle-std-rad 0.002 --gyroscope-std-rad-s 0.003 --accelerometer-std-m-s2 0.05 --tracker-std-m 0.002 --payload-kg 1",
    "funicular observability docs/estimation/robot.toml --poses docs/design/cogiro-poses.csv --sensors accelerometer,gyroscope --payload-std-kg 0.5 --first-moment-std-kg-m 0.05 --force-std-n 2 --moment-std-n-m 0.4 --force-time-s 2 --offset-std-m 0.002",
    f"funicular observability docs/estimation/robot.toml --sensors cable-angles --tension-bias-std-n 6 --friction 0.01 {STATE}",
    f"funicular calibrate {MACHINE} --accuracy-poses waypoints.csv --propose 1 --grid x=1:3:3 --propose-for tool",
    f"funicular compare {ROBOT} --below-hz 2",
    f"funicular compare robots/cogiro.toml --below-hz 6 {TENSIONS} --platform --platform-share 0.6 --tolerance 0.05",
    f"funicular gradient {ROBOT} --of frequencies,damping,tensions --below-hz 2 --per percent {LENGTHS}",
    f"funicular gradient robots/cogiro.toml {TENSIONS} --hold pose --of lengths,stiffness-min --by platform,cables.*.anchor_m",
    f"funicular gradient {ROBOT} --of response --at-hz 1.5 --input fz --output az --per tolerance --tolerances platform=2%",
    f"funicular gradient {ROBOT} --of response --at-hz 1.5 --input fz --output az --input-point-m 0.1,0,0 "
    f"--output-point-m 0,0,0.1 {STATE} --cable-model catenary-static --assembly consistent --winches clamped",
    f"funicular gradient robots/cogiro.toml --below-hz 3 {TENSIONS} --hold-lengths-of-pose --mass-kg 250",
    f"funicular payload robots/cogiro.toml {TENSIONS} {STATE} --payload-center-m 0,0,-0.2",
    "funicular payload robots/cogiro.toml --pose 1,2,1.5 --hold-lengths-of-pose --mass-kg 250",
    f"funicular loads robots/cogiro.toml {TENSIONS} {STATE} --required-force-n 20,20,20",
    f"funicular loads robots/cogiro.toml --pose 1,1,1.5 {REQUIRED}",
    f"funicular map robots/cogiro.toml --grid x=0:1:2 --grid y=1 --grid z=1.5 --quantity load-factor {REQUIRED}",
    f"funicular sweep robots/cogiro.toml --vary platform.mass_kg=80,90 --quantity load-factor {REQUIRED}",
    f"funicular speeds robots/cogiro-winches.toml {TENSIONS} {STATE} {VELOCITIES}",
    "funicular speeds robots/cogiro-winches.toml --pose 1,2,1.5 --hold-lengths-of-pose --mass-kg 110",
    f"funicular winches robots/cogiro-winches.toml --grid x=0:1:2 --grid z=1.5 --required-payload-max-kg 20 {VELOCITIES}",
    f"funicular winches robots/cogiro-winches.toml {TENSIONS} {STATE} {VELOCITIES}",
    f"funicular winches robots/cogiro-winches.toml --poses trajectory.csv --offers winches.csv --drum-width-m 0.2 {REQUIRED}",
    "funicular winches robots/cogiro-winches.toml --pose 1,1,1.5 --tension-rule middle",
    f"funicular map robots/cogiro-winches.toml --grid x=0:1:2 --grid z=1.5 --quantity speed-factor,speed-max:rz {VELOCITIES}",
    f"funicular sweep robots/cogiro-winches.toml --vary platform.mass_kg=90,95 --quantity motor-power {VELOCITIES}",
    f"funicular trajectory robots/cogiro.toml {TENSIONS} {STATE} --move-to 1.5,1,1.5,0,0,10 --via trajectory.csv --blend 0.5 {COURSE}",
    "funicular trajectory robots/cogiro.toml --path job.csv --path-origin-m 0,0,1.5 --speed-m-s 0.5 --acceleration-m-s2 1 --jerk-m-s3 10 --sample-time-s 0.5",
    "funicular trajectory robots/cogiro.toml --path path.csv --row-tolerance-m 0.00005 --duration-s 3 --rope-inertia",
    f"funicular trajectory robots/cogiro-winches.toml --pose 1,0,1.5 --circle-center-m 0,0,1.5 --circle-axis 0,0.1,1 --turns 0.5 {CIRCLE}",
    f"funicular trajectory robots/cogiro.toml --pose 1,2,1.5 --hold-lengths-of-pose --mass-kg 250 --move-to 1.5,1,1.5 --lift-m 0.2 {CIRCLE} --max-tension-n 1500 --fastest",
    f"funicular clearance robots/cogiro.toml {TENSIONS} {STATE}",
    "funicular clearance robots/cogiro.toml --pose 1,2,1.5 --hold-lengths-of-pose --mass-kg 250",
    "funicular clearance robots/cogiro.toml --pose 0,0,1.5 --move-to 1,0.5,1.5,0,0,10",
    "funicular workspace robots/cogiro.toml --grid z=-1:4:9 --step-m 1.5 --at-least load-factor=1 --required-force-n 150,150,150 --rays 18 --section z=1,2",
    "funicular workspace robots/ipanema2.toml --step-m 1 --at-most tension-max=2500 --grid yaw=-5,5 --orientations some --max-tension-n 3000",
    f"funicular workspace robots/cogiro.toml {TENSIONS} {STATE} {REQUIRED} --step-m 3 --vertex-tolerance-m 0.01 --rays 6 "
    "--center-m 0,0,1.5 --payload-center-m 0,0,-0.1",
    f"funicular workspace robots/cogiro.toml --step-m 3.5 --at-least first-platform-frequency=0.2 --max-tension-n 4000 {MODEL} "
    "--up-to-hz 50 --platform-share 0.6",
    "funicular workspace robots/cogiro.toml --step-m 3 --prove --boxes 50 --max-tension-n 4000",
    "funicular workspace robots/cogiro.toml --step-m 3 --prove --undecided 0.9 --time-s 100",
    "funicular prove robots/cogiro.toml --pose 0,0,1.5 --within-m 2,1,0.5 --within-deg 0.5,0,1 --boxes 40 --max-tension-n 4000 --required-force-n 20,20,20",
    "funicular prove robots/cogiro.toml --pose 0,0,1.5 --static-model spring --within-m 5,3,1 --undecided 0.5 --time-s 100",
    f"{PROVED} --mass-kg 60 --force-n 1,0,-5 --moment-n-m 0,0.1,0 --load-point-m 0,0,0.1 --wind-m-s 5,0,0 --cable-load-n-per-m 0,0,-0.1",
    f"{PROVED} --boxes 20 --min-tension-n 5 --required-shape box --required-moment-n-m 2,2,2",
    f"{PROVED} --required-payload-min-kg 5 --required-payload-max-kg 40 --required-payload-center-m 0,0,0.1 --required-payload-center-reach-m 0.1,0.1,0",
    f"{PROVED} --required-acceleration-m-s2 1,1,1",
    f"{PROVED} --required-angular-acceleration-rad-s2 0.2,0.2,0.2",
    "funicular identify robots/cogiro.toml --measured docs/identification/hall-decay.csv --history-kind decay --history-from-s 0.5 --history-to-s 6 --history-poles 1",
    f"funicular workspace robots/cogiro-winches.toml --step-m 3.5 --at-least speed-factor=1 --max-tension-n 4000 {VELOCITIES}",
    f"funicular statics robots/cogiro.toml {TENSIONS} --hold-lengths-of-pose --mass-kg 250 --set platform.mass_kg=200",
    f"funicular stiffness robots/cogiro.toml {TENSIONS} --hold-lengths-of-pose --mass-kg 250",
    f"funicular modes robots/cogiro.toml --below-hz 5 {TENSIONS} --hold-lengths-of-pose --mass-kg 250 --platform-share 0.9",
    f"funicular frf robots/cogiro.toml {RANGE} --input fz --output z {TENSIONS} --hold-lengths-of-pose --mass-kg 250",
    f"funicular compare robots/cogiro.toml --below-hz 4 {TENSIONS} --hold-lengths-of-pose --mass-kg 250",
    f"funicular cable robots/cogiro.toml --name 3 {RANGE} {TENSIONS} --hold-lengths-of-pose --mass-kg 250",
    f"funicular reduce robots/cogiro.toml --below-hz 4 --input fz --output z {TENSIONS} --hold-lengths-of-pose --mass-kg 250",
    f"funicular pose-error robots/cogiro.toml --mass-kg 100:200:3 {TENSIONS}",
    f"funicular report robots/cogiro.toml --below-hz 3 {TENSIONS} --hold-lengths-of-pose --mass-kg 250 --platform-share 0.9",
    f"funicular export robots/cogiro.toml --to vtk {TENSIONS} --hold-lengths-of-pose --mass-kg 250",
    "funicular map robots/cogiro.toml --grid x=0:1:2 --grid y=1 --grid z=1.5 --hold-lengths-of-pose --mass-kg 150 "
    "--payload-center-m 0,0,-0.1 --platform-share 0.75 --quantity payload-max,first-platform-frequency,tension-max-cable",
    "funicular sweep robots/cogiro.toml --pose 1,2,1.5 --vary platform.mass_kg=100,150 --hold-lengths-of-pose "
    "--payload-center-m 0,0,-0.1 --platform-share 0.75 --quantity pose,payload-max",
    f"funicular compare {ROBOT} --below-hz 2 --pose 0,0,0.5 {STATE} --assembly without-geometric-stiffness "
    "--in-plane-only --winches clamped",
    "funicular design robots/cogiro.toml --poses trajectory.csv --weights 2,1 --change platform.mass_kg=80:120 "
    "--min-frequency-hz 0.5 --min-stiffness-n-per-m 100 --avoid-hz 2.5:3.2 --max-iterations 3 --goal rope-length",
    "funicular design robots/cogiro.toml --grid x=0:1:2 --grid z=1.5 --change platform.mass_kg=80:120 --ropes ropes.csv --reconnect --goal rope-mass",
    f"funicular design robots/cogiro.toml --change cables.*.anchor_m=±0.1 {TENSIONS} {STATE} {MODEL}",
    f"funicular uncertainty {ROBOT} --deviations platform.mass_kg=1%,materials=2% --of tensions,frequencies,damping --below-hz 1.3 "
    "--method linear --pose 0,0,0.5 --hold-lengths-of-pose",
    f"funicular uncertainty robots/cogiro.toml {TENSIONS} {STATE} --tolerances cables.*.anchor_m=0.001 --hold pose --of lengths,stiffness-min",
    f"funicular uncertainty {ROBOT} --deviations platform.mass_kg=1% --of response --at-hz 0.8,1.2 --input fz --output az "
    "--input-point-m 0.1,0,0 --output-point-m 0,0.1,0",
    f"funicular uncertainty {ROBOT} --deviations platform.mass_kg=1% --method sampled --samples 20 --seed 3 {LENGTHS} {MODEL}",
    "funicular uncertainty robots/cogiro.toml --covariance covariance.csv --grid x=0:1:2 --grid z=1.5 --of pose",
    f"funicular cable {ROBOT} --name 3 {RANGE}",
    "funicular validate --only paper --level published",
    "funicular validate --only cube --controls",
    f"funicular cable {ROBOT} --name 3 {RANGE} --log --pose 0,0,0.5 {STATE} --cable-model shallow-dynamic "
    "--in-plane-only --winches stuck",
    f"funicular pose-error {ROBOT} --mass-kg 10.55:86.35:5 {LENGTHS} --tolerance-mm 5",
    f"funicular reduce {ROBOT} --below-hz 2 --input fx --input mz --output x --output rz --pose 0,0,0.5 --order 12",
    f"funicular reduce {ROBOT} --below-hz 2 --input fx --output ax --input-point-m 0.1,0,0 --output-point-m 0,0,0.1 "
    "--damping-at-hz 1 --tolerance 0.5",
    f"funicular reduce {ROBOT} --below-hz 1 --input fx --output x --tolerance 0.1 --form second-order {STATE} {WHOLE} "
    "--winches clamped",
    f"funicular map robots/cogiro.toml --grid z=1:2:2 {TENSIONS} {STATE} {MODEL} --quantity tensions --up-to-hz 50",
    f"funicular sweep {ROBOT} --vary cables.3.unstrained_length_m=6.7,6.8 --static-model spring --set platform.mass_kg=12",
    f"funicular report {ROBOT} --below-hz 3 --input mz --output arz --cable-model spring --mass-kg 12",
    f"funicular export {ROBOT} --to moordyn --segments 5 --pose 0,0,0.5 --mass-kg 12 --wind-m-s 5,0,0",
    f"funicular export {ROBOT} --to moordyn --segments 5 --mass-kg 12.5 --scenario docs/simulation/release.toml --duration-s 2",
    f"funicular export {ROBOT} --to mujoco --cable-pieces 3 --pose 0,0,0.5",
    f"funicular export {ROBOT} --to c --pose 0,0,0.5 --within x=-0.2:0.2 --within y=0.1 --tolerance-m 1e-5 --prefix t",
    f"funicular report {ROBOT} --summary",
    f"funicular report {ROBOT} --input-point-m 0.1,0,0 --output-point-m 0,0,0.1 {STATE} {MODEL}",
    f"funicular export robots/cogiro.toml --to vtk {TENSIONS} {STATE}",
    f"funicular sweep robots/cogiro.toml --vary platform.mass_kg=200,300 {TENSIONS} {STATE} {MODEL} --up-to-hz 50",
    f"funicular live robots/cogiro.toml {TENSIONS} {STATE} {MODEL} --hold-lengths-of-pose",
    "funicular identify robots/cogiro.toml --fit platform.mass_kg=80:200 --prior platform.mass_kg=93±10 --measured response.csv "
    "--response a1=az/fz --input-point-m 0.1,0,0 --output-point-m 0,0,0.1 --from-hz 0.5 --to-hz 3 --response-noise 0.03 "
    f"--starts 1 --pose 1,2,1.5 --hold-lengths-of-pose {MODEL}",
    f"funicular identify {ROBOT} --fit platform.mass_kg --measured test.uff --node 1=0.1,0,0 --node 2=0,0,0.1 --starts 1 "
    f"--profile platform.mass_kg {STATE}",
    f"funicular identify {ROBOT} --fit platform.center_of_mass_m.x --prior platform.center_of_mass_m.x=0±0.02 {LENGTHS} "
    "--measured-pose 0.02,0.01,0.45,0.1,2.9,-0.2 --position-std-m 0.002 --rotation-std-deg 0.2 "
    "--measured-tensions-n 17,36,40,15,50,52 --tension-std-n 2",
    f"funicular identify robots/cogiro.toml --fit platform.mass_kg {TENSIONS} --length-std-m 0.002 "
    "--measured-lengths-m 9.1,9.0,7.8,7.6,7.3,7.4,8.3,8.4",
    f"funicular identify {ROBOT} --fit platform.mass_kg {LENGTHS} --measured-tensions-n 17,36,40,15,50,52 --propose 1 "
    "--grid x=-0.1,0.1 --propose-measuring frequencies,tensions --propose-payloads-kg 0,2 --propose-modes 4 "
    "--payload-kg 1 --payload-center-m 0,0,-0.1 --propose-by determinant",
    f"funicular identify {ROBOT} --fit platform.mass_kg {LENGTHS} --measured-tensions-n 17,36,40,15,50,52 "
    "--wanted-percent 5 --poses near.csv --propose-for platform.mass_kg",
    "funicular identify robots/grab-4-cables.toml --fit platform.inertia_kg_m2 --experiments states.json --rigid-cables "
    "--starts 1 --frequency-noise 0.02 --damping-noise 0.2",
    "funicular paper",
    "funicular new",
    "funicular new --cables 6 --motion planar-xz --name rig --mass-kg 20 --box-m 0.4,0.3,0.2 --rope 7x7 --diameter-m 0.003 --pose 0,0,1.5",
    "funicular new --motion point-mass --axial-stiffness-n 1e6 --mass-kg-per-m 0.1",
    "funicular new --from-csv docs/robot-file.csv --csv-unit mm --mass-kg 60",
    "funicular schema",
    f"funicular parameters {ROBOT} --set loads.force_n.2=-5 --set cables.1.anchor_m.2=5.5",
    "funicular import docs/import/tripod.txt --mass-kg 7 --inertia-kg-m2 1,1,1,0,0,0 --center-of-mass-m 0,0,0.1 --diameter-m 0.01",
    "funicular import docs/import/tripod_bodies.xml docs/import/tripod_cables.xml --mass-kg-per-m 0.05 --youngs-modulus-pa 1e11 "
    "--diameter-m 0.005 --pose 0,0,1",
]

# Response in a Universal File: acceleration along z at node 2 per force along z at node 1, at 1, 1.5 and 2 Hz.
UNIVERSAL_FILE = """    -1
    58
NONE
NONE
NONE
NONE
NONE
    4         0    1         0 NONE               2   3 NONE               1   3
         5         3         1  1.00000E+00  5.00000E-01  0.00000E+00
        18    0    0    0 Frequency            Hz
        12    0    0    0 Acceleration         m/s^2
        13    0    0    0 Force                N
         0    0    0    0 NONE                 NONE
 -3.88000E-05 -3.40000E-06  3.78000E-02 -1.71000E-02 -1.63000E-02  0.00000E+00
    -1
"""
# Natural frequencies of a robot with four rigid cables in two states.
STATES = [
    {"name": "1", "static_model": "ideal", "pose": [1.08, -0.17, -0.1], "frequencies": [{"frequency_hz": 2.25, "label": "1"}]},
    {"name": "2", "static_model": "ideal", "pose": [0.57, -0.2, -0.17], "frequencies": [{"frequency_hz": 1.91, "std_hz": 0.02}]},
]


def lines() -> list[str]:
    """Lines of the help texts and of this file; without the program their tests are skipped."""
    executable = os.environ.get("FUNICULAR_PROGRAM")
    if not executable:
        return MORE
    told = [line for command in commands.commands(executable) for line in commands.examples(executable, command)]
    # A few examples name files of the reader.
    return [line for line in told if "robots/" in line or "docs/" in line or line == "funicular report"] + MORE


def windy() -> str:
    """Robot file with gusts."""
    rope = "drag_coefficient = 1.2\ndrag_diameter_m = 0.005\nmaximum_tension_n"
    text = (ROOT / "robots/stadium-camera.toml").read_text().replace("maximum_tension_n", rope, 1)
    return f"""{text}
[wind]
velocity_m_s = [12.0, 0.0, 0.0]
turbulence = "kaimal"
intensity = [0.15, 0.12, 0.075]
length_scale_m = [85.05, 28.35, 6.93]
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder with the robots of the repository, in which the examples run."""
    for name in ("robots", "docs"):
        (tmp_path / name).symlink_to(ROOT / name)
    poses = "x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg\n0.5,0.25,1.5,0,1,2\n0,0,2,0,0,0\n"
    (tmp_path / "trajectory.csv").write_text(poses)
    (tmp_path / "lengths.csv").write_text(LENGTHS_OVER_TIME)
    (tmp_path / "waypoints.csv").write_text("x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg\n3.7,3.5,0,0,0,0\n1,1,0,0,0,0\n")
    (tmp_path / "near.csv").write_text("x_m,y_m,z_m,roll_deg,pitch_deg,yaw_deg\n0,0.05,0.5,0,1,0\n")
    (tmp_path / "job.csv").write_text("x_m,y_m,z_m,feed_m_s\n0.2,0,0,0.1\n0.2,0.2,0,0.1\n")
    (tmp_path / "ropes.csv").write_text("name,axial_stiffness_n,mass_kg_per_m,diameter_m\nthin,300000,0.05,\nthick,900000,0.1,0.006\n")
    (tmp_path / "path.csv").write_text("t_s,x_m,y_m,z_m,yaw_deg\n0,0,0,1.5,0\n1,0.5,0.2,1.5,5\n2,1,0,1.6,10\n")
    (tmp_path / "winches.csv").write_text("name,tension_n,speed_m_s,power_w,rope_m\nsmall,800,1.2,900,\n7,3000,3,5000,60\n")
    (tmp_path / "covariance.csv").write_text(
        "first,second,covariance\ncables.1.anchor_m.x,cables.1.anchor_m.x,4e-6\ncables.1.anchor_m.x,cables.2.anchor_m.x,2e-6\n"
        "cables.2.anchor_m.x,cables.2.anchor_m.x,4e-6\n"
    )
    (tmp_path / "gusts.csv").write_text("frequency_hz,along_m2_s,lateral_m2_s,up_m2_s\n0.01,40,20,10\n0.1,8,6,4\n1,0.2,0.2,0.1\n")
    (tmp_path / "windy.toml").write_text(windy())
    (tmp_path / "response.csv").write_text("frequency_hz,a1_re,a1_im\n1,-5.16e-4,0\n2,-2.55e-3,0\n2.5,-7e-3,2e-4\n")
    (tmp_path / "test.uff").write_text(UNIVERSAL_FILE)
    (tmp_path / "states.json").write_text(json.dumps(STATES))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_every_command_that_computes_has_a_line(executable: str) -> None:
    found = lines()
    lacking = []
    for command in commands.commands(executable):
        if command not in ("request", "merge", "plot", "validate"):
            assert any(line.split()[1] == command for line in found), command
        for option in commands.options(executable, command):
            if option not in commands.OUTPUT and command not in ("plot", "request"):
                of_command = [line for line in found if line.split()[1] == command]
                used = any(option in line.split() for line in of_command)
                same = ("--set", "--static-model", "--lengths-m", "--pose", "--in-plane-only")
                excepted = (command, option) in (("loads", "--hold-lengths-of-pose"), ("winches", "--hold-lengths-of-pose"), ("observability", "--hold-lengths-of-pose"), ("reduce", "--to"), ("prove", "--required-wind-speed-m-s"))
                if not used and not excepted and option not in (*same, "--cable-set", "--compare", "--compare-set"):
                    lacking.append((command, option))
    assert lacking == []


def asked(executable: str, line: str) -> dict[str, Any]:
    words = commands.shlex.split(line)[1:]
    told = subprocess.run([executable, *words, "--print-request"], capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr
    found: dict[str, Any] = json.loads(told.stdout)
    return found


def ours(line: str) -> dict[str, Any]:
    command, files, keywords, changes = commands.call(line)
    if command == "import":
        sources = [json.loads(funicular._study.source_file(Path(path))) for path in files]
        return funicular._study.request(command, None, (), {"files": sources, **keywords})
    if command == "new":
        if "from_csv" in keywords:
            keywords["from_csv"] = json.loads(funicular._study.source_file(Path(keywords["from_csv"])))
        return funicular._study.request(command, None, (), keywords)
    if command == "schema":
        return funicular._study.complete({"command": command, **keywords})
    if command in ("paper", "validate"):
        return funicular._study.request(command, None, (), keywords)
    return commands.robot_of(files, changes).request(command, **keywords)


@pytest.fixture(scope="module")
def schema() -> Draft202012Validator:
    made = funicular.schema("request")
    Draft202012Validator.check_schema(made)
    return Draft202012Validator(made)


@pytest.mark.parametrize("line", lines())
def test_a_request_is_valid_by_the_schema_and_with_another_key_it_is_not(
    line: str, executable: str, schema: Draft202012Validator
) -> None:
    request = asked(executable, line)
    assert [error.message for error in schema.iter_errors(request)] == []
    assert not schema.is_valid(request | {"poze": 1})


@pytest.mark.parametrize("line", lines())
def test_a_command_line_and_a_call_are_one_request(line: str, executable: str) -> None:
    theirs, mine = asked(executable, line), ours(line)
    # Files are keywords of a call, not of its request.
    named = theirs.pop("write_files", {}).values()
    assert set(named) <= set(commands.shlex.split(line))
    assert mine == theirs
    # JSON keeps every number: a request comes back unchanged.
    assert funicular._study.complete(json.loads(json.dumps(mine))) == mine


# Commands whose results are compared; the others make pages, files or rows, which have their own tests.
COMPUTED = (
    *("check", "parameters", "statics", "stiffness", "modes", "frf", "compare", "gradient", "payload", "loads", "speeds", "winches", "trajectory", "simulate", "clearance", "workspace", "prove", "pose-error", "cable"),
    *("settle", "gust", "reduce", "identify", "calibrate", "estimate", "observability", "uncertainty"),
)


def plain(found: Any) -> Any:
    """Results with lists instead of arrays."""
    if isinstance(found, np.ndarray):
        if found.dtype.kind == "c":
            return {"real": found.real.tolist(), "imag": found.imag.tolist()}
        return found.tolist()
    if isinstance(found, dict):
        return {key: plain(value) for key, value in found.items()}
    return [plain(value) for value in found] if isinstance(found, (list, tuple)) else found


STATE_KEYS = {"hold_lengths_of_pose", "pose", "lengths_m", "mass_kg", "static_model", "force_n", "moment_n_m", "load_point_m", "wind_m_s"} | {
    *("cable_load_n_per_m", "tension_rule", "target_tension_n", "min_tension_n", "max_tension_n")
}


@pytest.mark.parametrize("line", [line for line in MORE if line.split()[1] in COMPUTED])
def test_a_call_and_a_request_have_the_results_of_the_program(line: str, executable: str) -> None:
    words = commands.shlex.split(line)[1:]
    told = subprocess.run([executable, *words, "--format", "json"], capture_output=True, text=True, check=True)
    theirs = json.loads(told.stdout)
    # Each front end names options in its own words.
    worded = [re.sub("--([a-z-]+)", lambda option: f"`{option[1].replace('-', '_')}`", of) for of in theirs.get("warnings", [])]
    if "warnings" in theirs:
        theirs["warnings"] = worded
    assert funicular.run(ours(line)) == theirs

    command, files, keywords, changes = commands.call(line)
    robot = commands.robot_of(files, changes)
    if command == "uncertainty":
        assert robot.uncertainty(**keywords).details == theirs
        return
    if command in ("pose-error", "payload", "loads", "speeds", "winches", "trajectory", "simulate", "clearance", "workspace", "prove", "calibrate", "estimate", "observability"):
        method = getattr(robot, command.replace("-", "_"))
        assert plain(method(**keywords)) == theirs
        return
    if command == "identify":
        assert plain(robot.identify(**keywords).to_dict()) == theirs
        return
    rest = robot.equilibrium(**{key: value for key, value in keywords.items() if key in STATE_KEYS})
    # Python takes frequencies instead of a range, and finds peaks by another function.
    of_range = {"from_hz", "to_hz", "points", "log", "prominence_db"}
    own = {key: value for key, value in keywords.items() if key not in STATE_KEYS | of_range}
    hz = theirs.get("frequency_hz")
    match command:
        case "statics":
            extra = rest.friction_interval if "friction_interval" in own else rest.all_equilibria
            assert (plain(extra()) if own else rest.to_dict(another_stable_equilibrium=True)) == theirs
        case "stiffness":
            matrix = rest.stiffness(**own)
            assert matrix.real.tolist() == theirs["real"] and matrix.imag.tolist() == theirs["imag"]
        case "modes":
            assert rest.modes(**own).to_dict() == theirs
        case "gradient":
            assert plain(rest.gradient(**own)) == theirs
        case "settle":
            assert plain(rest.settle(**own)) == theirs
        case "gust":
            assert plain(rest.gust(**own)) == theirs
        case "compare":
            assert plain(rest.compare(**own)) == theirs
        case "reduce":
            reduced = rest.reduce if own.pop("form", "") == "second-order" else rest.state_space
            assert reduced(**own).to_dict() == theirs
        case "cable":
            assert plain(rest.cable(hz=hz, **own)) == theirs
        case "frf":
            # The frequencies that the program chose are enough: their values are those of a plain response.
            own.pop("adaptive", None)
            response = rest.frf(hz, **own).reshape(-1, len(hz))
            pairs = theirs.get("responses", [theirs])
            assert response.real.tolist() == [pair["real"] for pair in pairs]
            assert response.imag.tolist() == [pair["imag"] for pair in pairs]


def test_modes_have_their_parts_in_a_response_and_shapes_along_the_cables() -> None:
    modes = funicular.Robot.example().modes(3, input="fz", output="az", stations=5)
    assert modes.cable_shapes is not None and modes.cable_shapes.shape == (len(modes), 6, 5, 3)
    assert modes.cable_axes is not None and modes.station_position_m is not None and modes.station_arc_length_m is not None
    assert np.allclose(modes.cable_axes @ modes.cable_axes.transpose(0, 2, 1), np.eye(3), atol=1e-12)
    # The anchor is fixed; the other end moves with the platform.
    assert np.abs(modes.cable_shapes[:, :, -1]).max() < 1e-9 * np.abs(modes.cable_shapes).max()
    rest = funicular.Robot.example().equilibrium()
    arms = modes.station_position_m[:, 0] - rest.pose.position_m
    moved = modes.shape[:, None, :3] + np.cross(modes.shape[:, None, 3:], arms)
    assert np.allclose(np.einsum("kij,mkj->mki", modes.cable_axes, moved), modes.cable_shapes[:, :, 0], atol=1e-6)
    assert modes.peak is not None and modes.peak_unit == "(m/s²)/N" and modes.peak.shape == (len(modes),)
    assert modes.residue_per_kg is not None and len(modes.to_pandas()["peak"]) == len(modes)


def test_a_reduced_model_has_the_frequencies_and_responses_of_the_robot(tmp_path: Path) -> None:
    rest = funicular.Robot.example().equilibrium()
    model = rest.reduce(3, ["fz"], ["z", "az"])
    assert np.allclose(model.mass, model.mass.T) and np.allclose(model.stiffness, model.stiffness.T)
    found = np.sqrt(np.linalg.eigvals(np.linalg.solve(model.mass, model.stiffness)).real) / (2 * np.pi)
    assert np.allclose(np.sort(found)[: len(rest.modes(3))], rest.modes(3).frequency_hz, rtol=1e-6)
    a, b, c, d = model.state_space()
    hz = np.array([0.5, 1.3, 2.4])
    for i, signal in enumerate(("z", "az")):
        response = np.array([(c @ np.linalg.solve(2j * np.pi * f * np.eye(len(a)) - a, b) + d)[i, 0] for f in hz])
        # Damping that was made viscous is exact at natural frequencies alone.
        bound = 2 * ((model.damping_error or 0) + (model.truncation_error or 0))
        expected = rest.frf(hz, "fz", signal)
        assert np.abs(response - expected).max() < bound * np.abs(expected).max()
    model.save(tmp_path / "model.npz")
    assert np.array_equal(np.load(tmp_path / "model.npz")["ss_A"], a)
    with pytest.raises(funicular.InputError, match=r"must end in \.npz or \.mat"):
        model.save(tmp_path / "model.csv")


def test_a_reduced_model_goes_to_scipy_and_control() -> None:
    model = funicular.Robot.example().reduce(2, ["fz"], ["z"])
    scipy = pytest.importorskip("scipy.signal")
    system = model.to_scipy()
    assert isinstance(system, scipy.StateSpace)
    # `scipy.signal.freqresp` takes polynomials in between, which rounding spoils for so many states.
    for given, expected in zip((system.A, system.B, system.C, system.D), model.state_space(), strict=True):
        assert np.array_equal(given, expected)
    pytest.importorskip("control")
    assert model.to_control().input_labels == ["fz"]


def test_files_and_pages_are_those_of_the_program(executable: str, folder: Path) -> None:
    def run(line: str) -> None:
        subprocess.run([executable, *line.split()], check=True, capture_output=True)

    robot = funicular.Robot.from_file(ROBOT)
    rest = robot.equilibrium(pose=[0, 0, 0.5])
    for to, ending, keywords in [("opensees", "py", {}), ("moordyn", "txt", {}), ("mujoco", "xml", {}), ("mujoco", "xml", {"cable_pieces": 4}), ("sdf", "sdf", {}), ("urdf", "urdf", {}), ("vtk", "vtp", {"modes_below_hz": 2})]:
        more = "".join(f" --{key.replace('_', '-')} {value}" for key, value in keywords.items())
        run(f"export {ROBOT} --to {to} --pose 0,0,0.5 --segments 5{more} -o theirs.{ending}")
        rest.export(to, f"ours.{ending}", segments=5, **keywords)
        assert Path(f"ours.{ending}").read_bytes() == Path(f"theirs.{ending}").read_bytes()
        made = funicular.run(robot.request("export", to=to, pose=[0, 0, 0.5], segments=5, **keywords))
        assert made.text == Path(f"ours.{ending}").read_text()

    for to in ("c", "json"):
        run(f"export {ROBOT} --to {to} --pose 0,0,0.5 --within x=-0.2:0.2 --within y=-0.2:0.2 --tolerance-m 1e-5 -o theirs.{to}")
        within = {"x": (-0.2, 0.2), "y": [-0.2, 0.2]}
        rest.export(to, f"ours.{to}", within=within, tolerance_m=1e-5)
        assert Path(f"ours.{to}").read_bytes() == Path(f"theirs.{to}").read_bytes()
        made = funicular.run(robot.request("export", to=to, pose=[0, 0, 0.5], within=within, tolerance_m=1e-5))
        assert made.text == Path(f"ours.{to}").read_text()
    with pytest.raises(funicular.InputError, match="`within`"):
        rest.export("c", "none.c")
    with pytest.raises(funicular.Error, match="wholly feasible"):
        rest.export("c", "none.c", within={"x": (-20, 20)})

    files = ["docs/import/tripod_bodies.xml", "docs/import/tripod_cables.xml"]
    run(f"import {' '.join(files)} --mass-kg-per-m 0.05 --axial-stiffness-n 1e6 -o theirs.toml")
    imported = funicular.import_robot(files, mass_kg_per_m=0.05, axial_stiffness_n=1e6)
    imported.write("ours.toml")
    # Comments name options as the program or as Python writes them.
    theirs = re.sub("--([a-z][a-z-]+)", lambda name: f"`{name[1].replace('-', '_')}`", Path("theirs.toml").read_text())
    assert Path("ours.toml").read_text() == theirs
    assert imported.robot.equilibrium().stable
    with pytest.raises(funicular.InputError, match="`mass_kg_per_m`"):
        funicular.import_robot(files)

    run("new --from-csv docs/robot-file.csv --csv-unit mm --mass-kg 60 -o new-theirs.toml")
    new = funicular.new_robot(from_csv="docs/robot-file.csv", csv_unit="mm", mass_kg=60)
    new.write("new-ours.toml")
    assert Path("new-ours.toml").read_bytes() == Path("new-theirs.toml").read_bytes()
    assert new.warnings == () and new.robot.equilibrium().stable
    with pytest.raises(FileExistsError, match="may hold your own numbers"):
        new.write("new-ours.toml")
    with pytest.raises(funicular.InputError, match="`cables` 1: one cable"):
        funicular.new_robot(cables=1)

    page = rest.report("ours.html", below_hz=3)
    assert Path("ours.html").read_text() == page.html and "robot.equilibrium(" in page.html
    assert "<iframe" in page._repr_html_() and "<html" not in page._repr_html_()
    rows = robot.map({"x": (-1, 1, 3), "y": 0, "z": 0.5}, file="map.parquet")
    with pytest.raises(funicular.InputError, match="would hold one figure"):
        rows.plot("map.pdf")
    shown = rows.plot("map.html")
    assert Path("map.html").read_text() == shown.html and "tension" in shown.html
    assert "rows in memory" in robot.map({"x": (-1, 1, 3), "y": 0, "z": 0.5}).plot().html


def test_a_live_page_has_the_robot_or_says_how_to_build_with_the_page() -> None:
    """The page is part of the package only if it was built with FUNICULAR_PAGE, as releases are."""
    try:
        page = funicular.Robot.example().equilibrium(pose=[0, 0, 0.5]).live("live.html", cable_model="spring")
    except funicular.InputError as error:
        assert "this build does not contain the page: in the sources of funicular, `scripts/install`" in str(error)
    else:
        assert '"cable_model":"spring"' in page.html
        assert Path("live.html").read_text() == page.html



def test_parts_of_a_map_are_one_file(folder: Path) -> None:
    robot = funicular.Robot.from_file(ROBOT)
    grid = {"x": (-1, 1, 40), "y": (-1, 1, 10), "z": 0.5}
    robot.map(grid, file="whole.parquet")
    seen: list[tuple[int, int]] = []
    for k in (1, 2, 3):
        part = robot.map(grid, file=f"{k}.parquet", part=f"{k}/3", progress=lambda *rows: seen.append(rows))
        assert part.complete and 0 < len(part) < 400 and seen[-1] == (len(part), len(part))
    assert len(funicular.merge([f"{k}.parquet" for k in (1, 2, 3)], "merged.parquet")) == 400
    assert Path("merged.parquet").read_bytes() == Path("whole.parquet").read_bytes()
    for keywords, told in [({"part": "4/3", "file": "x.parquet"}, "`part`: `4/3` is not a part"), ({"part": "1/3"}, "`part` goes with")]:
        with pytest.raises(funicular.InputError, match=told):
            robot.map(grid, **keywords)  # type: ignore[arg-type]
    with pytest.raises(funicular.FileError, match="written without `part`"):
        funicular.merge(["whole.parquet"], "again.parquet")


def test_every_comparison_of_the_validation_passes() -> None:
    found = funicular.validate()
    assert found["passed"] == found["comparisons"] > 50


def test_comparisons_are_chosen_and_written_for_build_servers(tmp_path: Path) -> None:
    report, badge = tmp_path / "report.xml", tmp_path / "badge.svg"
    found = funicular.validate(only="catenary/michalos-1962", level="published", junit=report, badge=badge)
    assert [row["id"] for section in found["sections"] for row in section["rows"]] == ["catenary/michalos-1962/displacement-printed"]
    assert 'tests="1" failures="0"' in report.read_text() and "1 of 1 pass" in badge.read_text()
    with pytest.raises(funicular.InputError, match="did you mean"):
        funicular.validate(only="catenery")


@pytest.mark.parametrize(
    ("request_", "told"),
    [
        ({"command": "statik"}, "there is no command `statik`; did you mean `statics`?"),
        ({"command": "compare", "robot": {"text": "x"}}, "below_hz"),
        ({"command": "statics", "robot": {"text": ""}, "poze": 1}, "has no key `poze`; did you mean `pose`"),
        ({"command": "merge", "parts": []}, "funicular.merge"),
        ({"command": "statics", "robot": {"text": ""}, "mass_kg": float("nan")}, "NaN is not a finite number"),
    ],
)
def test_requests_that_mean_nothing_are_explained(request_: dict[str, Any], told: str) -> None:
    with pytest.raises(funicular.InputError, match=told):
        funicular.run(request_)
