//! Refusals of `import`, with line and reason.

use super::*;

/// Files, change of the text, more arguments, part of the message.
type Refused = (&'static [&'static str], (&'static str, &'static str), &'static [&'static str], &'static str);

#[test]
#[expect(clippy::too_many_lines, reason = "a table")]
fn bad_files_are_refused_at_their_line_with_the_reason() {
    const WIREX: &[&str] = &["tripod.wcrfx"];
    const MOORDYN: &[&str] = &["tripod.txt"];
    const POSE: &str = "SPATIAL_EULER_XYZ\" q_initial=\"0.1 -0.05 1.5 0.02 -0.03 0.05\"";
    let cases: &[Refused] = &[
        // CASPR: bodies.
        (&CASPR, (POSE, "R_Z\" q_initial=\"0\""), &[], "joint `R_Z` is a link that only rotates about a fixed point"),
        (&CASPR, (POSE, "P_XY\" q_initial=\"0 0\""), &[], "translates along fewer than three axes"),
        (&CASPR, (POSE, "HINGE\" q_initial=\"0\""), &[], "joint `HINGE` is of an unknown kind"),
        (&CASPR, (POSE, "T_XYZ\" actuated=\"true\" q_initial=\"0 0 0\""), &[], "the joint is actuated"),
        (&CASPR, ("0.02 -0.03 0.05", "0.02 -0.03"), &[], "holds 5 numbers, SPATIAL_EULER_XYZ needs 6"),
        (&CASPR, ("0.02 -0.03 0.05", "0.02 -0.03 x"), &[], "`q_initial` holds `x`, which is not a number"),
        (&CASPR, (POSE, "SPATIAL_QUATERNION\" q_initial=\"0 0 1 0 0 0 0\""), &[], "the quaternion zero"),
        (&CASPR, ("</link_rigid>", "</link_rigid><link_rigid num=\"2\"/>"), &[], "the robot has 2 links"),
        (&CASPR, ("<num>0", "<num>1"), &[], "has to be the base, link 0"),
        (&CASPR, ("<mass>60.0</mass>", ""), &[], "bodies.xml:8:7: <physical> has no <mass>"),
        (&CASPR, ("<mass>60.0", "<mass>-1"), &[], "bodies.xml:9:9: <mass> is -1 kg, it must be positive"),
        (&CASPR, ("<mass>60.0", "<mass>60,0"), &[], "decimals are written with a point"),
        (&CASPR, ("<mass>60.0", "<mass>NaN"), &[], "<mass> is NaN, which is not a finite number"),
        (&CASPR, ("<mass>60.0", "<mass>60 kg"), &[], "<mass> is `60 kg`, which is not a number"),
        (&CASPR, ("<com_location>0.01 ", "<com_location>"), &[], "<com_location> holds 2 numbers; it must hold three"),
        (&CASPR, ("ref=\"com\"", "ref=\"end\""), &[], "attribute `ref` of <inertia> is `end`"),
        (&CASPR, ("<Ixx>4.0", "<Ixx>40"), &[], "fits no body"),
        (&CASPR, ("<Ixx>4.0", "<Ixx>-4"), &[], "--inertia-kg-m2"),
        (&CASPR, ("</link_rigid>", ""), &[], "not well-formed XML"),
        // CASPR: cables.
        (
            &CASPR,
            ("cable_ideal name=\"1\" ", "cable_ideal name=\"1\" x"),
            &[],
            "has no attribute `attachment_reference`",
        ),
        (&CASPR, ("attachment_reference=\"joint\"", "attachment_reference=\"end\""), &[], "it must be joint or com"),
        (
            &CASPR,
            ("<attachments>", "<attachments><attachment/>"),
            &[],
            "cable \"1\" has 3 attachments; a cable of a robot file",
        ),
        (&CASPR, ("<link>0</link>", "<link>2</link>"), &[], "<link> of cable \"1\" is `2`; 0 is the base"),
        (&CASPR, ("<link>0</link>", "<link>1</link>"), &[], "has both ends on the platform"),
        (&CASPR, ("<location>0.15 4.0 5.0</location>", ""), &[], "<attachment> has no <location>"),
        (&CASPR, ("<K>1e6", "<K>0"), &["--cable-set", "springs"], "<K> of cable \"1\" is 0 N, it must be positive"),
        (&CASPR, ("default_cable_set=\"ideal\"", ""), &[], "choose one with --cable-set: \"ideal\" and \"springs\""),
        (
            &CASPR,
            ("default_cable_set=\"ideal\"", "default_cable_set=\"old\""),
            &[],
            "default_cable_set names the set \"old\", which does not exist",
        ),
        (&CASPR, ("id=\"springs\"", "id=\"ideal\""), &[], "a second set is called \"ideal\""),
        (&CASPR, ("<cables ", "<cables "), &["--cable-set", "spring"], "did you mean \"springs\"?"),
        // WireX.
        (WIREX, ("3R3T", "2R3T"), &[], "a robot file cannot hold the motion pattern 2R3T"),
        (WIREX, ("3R3T", "6T"), &[], "attribute `motionpattern` is `6T`"),
        (WIREX, ("x=\"0.15\"", "x=\"0,15\""), &[], "tripod.wcrfx:5:17: attribute `x` of <base> is `0,15`"),
        (WIREX, ("x=\"0.15\"", ""), &[], "<base> has no attribute `x`"),
        (WIREX, ("mass=\"60.0\"", "mass=\"-60.0\""), &[], "attribute `mass` is -60 kg"),
        (WIREX, ("mass=\"60.0\"", ""), &[], "the platform has no mass, give --mass-kg KG"),
        (WIREX, ("elasticity=\"5e10\"", ""), &[], "--axial-stiffness-n"),
        (WIREX, ("radius=\"0.002\"", ""), &[], "the diameter of the ropes, give --diameter-m"),
        (WIREX, ("weight=\"0.05\"", ""), &[], "--mass-kg-per-m"),
        (
            WIREX,
            ("weight=\"0.05\"", "weight=\"-1\""),
            &[],
            "attribute `weight` of <cable> is -1, it cannot be negative",
        ),
        (WIREX, ("<robot ", "<wireRobot/><robots "), &[], "not well-formed XML"),
        (
            WIREX,
            ("<models", "<models"),
            &["--cable-set", "a"],
            "--cable-set chooses among the sets of a CASPR cables file",
        ),
        // MoorDyn.
        (
            MOORDYN,
            ("---------------------- LINES", "--- RODS ---\na\nb\n1 rope Body1\n--- LINES"),
            &[],
            "the file has rods",
        ),
        (MOORDYN, ("1     rope       1 ", "1     rope       R1A "), &[], "ends at rod `R1A`"),
        (
            MOORDYN,
            ("1     rope       1 ", "1     rope       4.98 "),
            &[],
            "the columns have to be those of MoorDyn version 2",
        ),
        (MOORDYN, ("1     rope       1 ", "1     rope       99 "), &[], "ends at point 99, which is not defined"),
        (
            MOORDYN,
            ("1     rope       1 ", "1     chain      1 "),
            &[],
            "line 1 is of type `chain`, which is not defined",
        ),
        (MOORDYN, ("1     Fixed ", "1     Free  "), &[], "ends at point 1, which is not fixed"),
        (MOORDYN, ("1     Fixed ", "1     Loose "), &[], "tripod.txt:14: point 1 is `LOOSE`"),
        (MOORDYN, ("3     Fixed ", "1     Fixed "), &[], "a second point has the number 1"),
        (MOORDYN, ("1     free ", "1     fixed"), &[], "body 1 is fixed, so nothing moves"),
        (
            MOORDYN,
            ("0.05     1e6 ", "0.05     curve.txt "),
            &[],
            "a separate file with a table of tension over strain is not read",
        ),
        (MOORDYN, ("4.98331806931662", "-4.9"), &[], "column 5 (UnstrLen) is -4.9 m, it must be positive"),
        (MOORDYN, ("4.0|5.0|7.0", "4.0|5.0"), &[], "column 11 (I) holds 2 numbers"),
        (MOORDYN, ("60.0", "60,0"), &[], "tripod.txt:10: column 9 (Mass) is `60,0`, which is not a number"),
        (MOORDYN, ("60.0", "0"), &[], "give --mass-kg KG"),
    ];
    for (files, change, more, expected) in cases {
        let ropes: &[&str] = if *files == CASPR { &ROPES } else { &[] };
        let output = Changed::of(files, &[*change]).import(&[ropes, more].concat());
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{change:?}: {message}\n{}", stdout(&output));
        assert!(message.contains(expected), "{change:?}: expected `{expected}` in {message}");
        assert_eq!(message.lines().count(), 1, "{change:?}: one line, not {message}");
        assert!(output.stdout.is_empty(), "{change:?}");
    }
}

#[test]
fn kinds_of_cables_that_a_robot_file_does_not_have_are_refused() {
    for (kind, why) in [
        ("cable_passive_linear_spring", "a passive spring"),
        ("cable_vsd_torsion_spring", "a device of variable stiffness"),
        ("muscle_hill_type", "a muscle"),
        ("rope", "of an unknown kind"),
    ] {
        let cables = format!("<cables default_cable_set='a'><cable_set id='a'><{kind} name='s'/></cable_set></cables>");
        let message = caspr_with_cables(&cables);
        assert!(message.contains(&format!("<{kind}> \"s\" is ")) && message.contains(why), "{message}");
    }
    let message = caspr_with_cables("<cables default_cable_set='a'><cable_set id='a'/></cables>");
    assert!(message.contains("cables.xml:1:31: cable set \"a\" has no cables"), "{message}");
    assert!(caspr_with_cables("<cables/>").contains("<cables> has no <cable_set>"));
}

/// The message on the example's body with another file of cables.
fn caspr_with_cables(cables: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cables.xml");
    fs::write(&path, cables).unwrap();
    let output = import(&[&[&example("tripod_bodies.xml"), path.to_str().unwrap()], &ROPES[..]].concat());
    assert_eq!(output.status.code(), Some(2));
    stderr(&output).to_owned()
}

#[test]
fn files_that_are_none_of_one_robot_are_refused() {
    let [bodies, cables] = caspr();
    let (wirex, moordyn) = (example("tripod.wcrfx"), example("tripod.txt"));
    let yuan = crate::robot("yuan2014-4mm.toml");
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let (svg, empty) = (file("a.svg", b"<svg/>"), file("empty", b""));
    let (binary, declared) =
        (file("b", b"<a>\0</a>"), file("c", b"<?xml version='1.0' encoding='utf-8'?><a b='\xE4'/>"));
    let robots = file("d.wcrfx", b"<models><wireRobot/></models>");
    for (arguments, expected) in [
        (&[][..], "required"),
        (&["no-such-file.xml"], "cannot read no-such-file.xml"),
        (&["/"], "it is a directory"),
        (&["/dev/zero"], "larger than 16 MiB"),
        (&[&bodies], "no CASPR cables file"),
        (&[&cables], "no CASPR bodies file"),
        (&[&bodies, &bodies, &cables], "are both a CASPR bodies file"),
        (&[&bodies, &cables, &wirex], "to more than one program"),
        (&[&wirex, &wirex], "are both a WireX file"),
        (&[&moordyn, &moordyn], "2 MoorDyn input files"),
        (&[&yuan], "neither XML"),
        (&[&empty], "neither XML"),
        (&[&svg], "a.svg:1:1: the outermost element is <svg>"),
        (&[&binary], "character 4 is zero"),
        (&[&declared], "no text in UTF-8"),
        (&[&robots], "the old format of WireX"),
        (&[&wirex, "--diameter-m", "0"], "0 is not positive"),
        (&[&wirex, "--mass-kg-per-m", "-1"], "-1 is negative"),
        (&[&wirex, "--axial-stiffness-n", "1e6", "--diameter-m", "0.01"], "cannot be used with"),
        (&[&wirex, "--inertia-kg-m2", "1,2"], "2 numbers where xx,yy,zz"),
        (&[&wirex, "-o", &wirex], "refusing to write the robot file over the source file"),
    ] {
        let output = import(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{arguments:?}: {}", stderr(&output));
    }
    assert_eq!(fs::read_to_string(&wirex).unwrap(), example_text("tripod.wcrfx"));
}
