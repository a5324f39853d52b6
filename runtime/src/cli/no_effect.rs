//! Options that would change nothing in the picture that is asked for. They are refused, with what to leave out:
//! whoever gives one expects to see it.

use super::args::{AmbientChoice, FilterChoice, LightChoice, LookArgs, OutputChoice, TechniqueChoice};
use clap::ValueEnum;
use sunbake::console::Failure;
use sunbake_runtime::shadow_maps::Variant;

/// Refuses options without effect, as far as options alone tell.
pub fn check(look: &LookArgs, output: OutputChoice) -> Result<(), Failure> {
    check_volumes(look, output)?;
    check_maps(look)?;
    check_lights(look, output)?;
    check_ambient(look, output)
}

/// Refuses a technique that finds the shadows of lights where none is on. A scene that is not baked has no other.
pub fn check_sky_of_set(look: &LookArgs) -> Result<(), Failure> {
    if look.light == LightChoice::Sky && look.technique != TechniqueChoice::Baked {
        return usage("--technique has no effect with --light sky, which no technique shades: leave one of them out");
    }
    Ok(())
}

/// Refuses a filter where no stored times are read. Beside shadow maps these are a lamp's, if the stage has one.
pub fn check_filter(look: &LookArgs, output: OutputChoice, has_lamp: bool) -> Result<(), Failure> {
    let Some(filter) = look.filter.filter(|filter| *filter != FilterChoice::Bilinear) else { return Ok(()) };
    let filter = format!("--filter {} has no effect", spelling(&filter));
    let shows_lamp = match output {
        OutputChoice::Visibility => look.light == LightChoice::Lamp,
        _ => matches!(look.light, LightChoice::Lamp | LightChoice::Both),
    };
    match look.technique {
        TechniqueChoice::Baked if output != OutputChoice::Visibility && look.light == LightChoice::Sky => {
            usage(format!("{filter} with --light sky, which reads no times: leave one of them out"))
        }
        TechniqueChoice::Baked => Ok(()),
        TechniqueChoice::Map(_) if has_lamp && shows_lamp => Ok(()),
        _ => usage(format!("{filter} with this --technique, which reads no times: leave it out, or draw baked")),
    }
}

fn usage(text: impl Into<String>) -> Result<(), Failure> {
    Err(Failure::usage(text))
}

/// How a choice is written.
fn spelling(choice: &impl ValueEnum) -> String {
    choice.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}

fn check_volumes(look: &LookArgs, output: OutputChoice) -> Result<(), Failure> {
    let is_volumes = matches!(look.technique, TechniqueChoice::Volumes(_));
    if output == OutputChoice::Volumes && !is_volumes {
        return usage("there are no volumes to show: draw --technique volumes, or leave --output volumes out");
    }
    if output == OutputChoice::Volumes && look.light == LightChoice::Sky {
        return usage("the sky has no shadow volumes: leave --light sky out, or --output volumes");
    }
    if look.sun_samples > 1 && !is_volumes {
        return usage("--sun-samples is for --technique volumes; of truth give truth:soft:N");
    }
    Ok(())
}

/// Options of shadow maps are for shadow maps.
fn check_maps(look: &LookArgs) -> Result<(), Failure> {
    let variant = match look.technique {
        TechniqueChoice::Map(variant) => Some(variant),
        _ => None,
    };
    let has_map = variant.is_some_and(|variant| variant != Variant::Planar);
    for (is_given, option) in [(look.map_size.is_some(), "--map-size"), (look.bias.is_some(), "--bias")] {
        if is_given && !has_map {
            return usage(format!("{option} is for --technique map and its variants that have one: leave it out"));
        }
    }
    if look.cascades.is_some() && variant != Some(Variant::Cascades) {
        return usage("--cascades is for --technique map:cascades: leave it out");
    }
    Ok(())
}

fn check_lights(look: &LookArgs, output: OutputChoice) -> Result<(), Failure> {
    let light = format!("--light {}", spelling(&look.light));
    if matches!(look.technique, TechniqueChoice::Map(_)) && look.light == LightChoice::Lamp {
        return usage("shadow maps are the sun's, and a lamp has its baked shadows: draw --technique baked");
    }
    if output == OutputChoice::Visibility && look.light == LightChoice::Sky {
        return usage(format!("{light} has no effect with --output visibility, which shows the sun's: leave it out"));
    }
    let of_sun = [
        (look.sun_samples > 1, "--sun-samples"),
        (look.map_size.is_some(), "--map-size"),
        (look.cascades.is_some(), "--cascades"),
        (look.bias.is_some(), "--bias"),
    ];
    let given = of_sun.into_iter().find(|(is_given, _)| *is_given);
    if let Some((_, option)) = given.filter(|_| matches!(look.light, LightChoice::Sky | LightChoice::Lamp)) {
        return usage(format!("{option} is about the sun's shadows, and {light} is without the sun: leave one out"));
    }
    if look.lamp_range.is_some() && matches!(look.light, LightChoice::Sun | LightChoice::Sky) {
        return usage(format!("--lamp-range has no effect with {light}, which is without the lamp: leave one out"));
    }
    Ok(())
}

fn check_ambient(look: &LookArgs, output: OutputChoice) -> Result<(), Failure> {
    if look.ambient == AmbientChoice::Best {
        return Ok(());
    }
    let ambient = format!("--ambient {} has no effect", spelling(&look.ambient));
    if output == OutputChoice::Visibility {
        return usage(format!("{ambient} with --output visibility, which shows no ambient light: leave it out"));
    }
    if matches!(look.light, LightChoice::Sun | LightChoice::Lamp) {
        let light = spelling(&look.light);
        return usage(format!("{ambient} with --light {light}, which is without ambient light: leave one out"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::args::{Args, Command};
    use super::*;
    use clap::Parser;

    /// What is said of options; nothing where each has its effect.
    fn said(options: &str, has_lamp: bool) -> Option<String> {
        let command = format!("sunplay frame set -o out.png {options}");
        let args = Args::try_parse_from(command.split_whitespace()).unwrap_or_else(|error| panic!("{error}"));
        let Command::Frame(args) = args.command else { unreachable!() };
        let checked = check(&args.look, args.output).and_then(|()| check_sky_of_set(&args.look));
        checked.and_then(|()| check_filter(&args.look, args.output, has_lamp)).err().map(|failure| failure.message)
    }

    #[test]
    fn options_without_effect_are_refused_by_name() {
        for (options, words) in [
            ("--technique map --filter nearest", ["--filter nearest", "draw baked"]),
            ("--technique volumes --filter sharp", ["--filter sharp", "leave it out"]),
            ("--technique truth:hard --filter sharp", ["--filter sharp", "reads no times"]),
            ("--filter nearest --light sky", ["--filter nearest", "--light sky"]),
            ("--output visibility --ambient ao", ["--ambient ao", "--output visibility"]),
            ("--light sun --ambient hemisphere", ["--ambient hemisphere", "--light sun"]),
            ("--light lamp --ambient bent", ["--ambient bent", "--light lamp"]),
            ("--light sky --output visibility", ["--light sky", "the sun's"]),
            ("--light sun --lamp-range 5", ["--lamp-range", "--light sun"]),
            ("--technique volumes --sun-samples 4 --light lamp", ["--sun-samples", "--light lamp"]),
            ("--technique map --map-size 512 --light sky", ["--map-size", "--light sky"]),
            ("--technique map:plain --cascades 3", ["--cascades", "map:cascades"]),
            ("--technique map:planar --bias none", ["--bias", "leave it out"]),
            ("--technique truth:soft --sun-samples 4", ["--sun-samples", "truth:soft:N"]),
            ("--output volumes", ["no volumes to show", "--technique volumes"]),
            ("--technique map --light lamp", ["a lamp has its baked shadows", "--technique baked"]),
            ("--technique truth:hard --light sky", ["--technique has no effect", "--light sky"]),
        ] {
            let text = said(options, false).unwrap_or_else(|| panic!("{options} is let through"));
            assert!(words.iter().all(|word| text.contains(word)), "{options}: {text}");
        }
    }

    #[test]
    fn options_with_an_effect_are_let_through() {
        for options in [
            "",
            "--filter nearest",
            "--filter sharp --output visibility",
            "--technique truth:hard --filter bilinear",
            "--technique map --map-size 512 --bias none --cascades 2",
            "--technique volumes --sun-samples 4 --light sun",
            "--light sky --ambient ao",
            "--light lamp --lamp-range 5",
            "--technique volumes --output volumes --ambient ao",
        ] {
            assert_eq!(said(options, false), None, "{options}");
        }
        // A lamp's times are read beside shadow maps of the sun.
        assert_eq!(said("--technique map --filter nearest", true), None);
        assert!(said("--technique map --filter nearest --light sun", true).is_some());
        assert!(said("--technique map --filter nearest --output visibility", true).is_some());
    }
}
