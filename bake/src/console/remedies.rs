//! A [`Remedy`] in the options of a command.

use super::Command;
use crate::remedy::{Remedy, Setting};

/// The option of a command that changes a setting. None where it has none.
fn option(setting: Setting, command: Command) -> Option<&'static str> {
    match (setting, command) {
        (Setting::PageSize, Command::Sunbake) => Some("--size"),
        (Setting::PageSize, Command::Sunplay) => Some("--page-size"),
        (Setting::PictureSize, Command::Sunplay) => Some("--size"),
        (setting, Command::Sunbake) => option_of_sunbake(setting),
        (setting, Command::Sunplay) => option_of_sunplay(setting),
    }
}

fn option_of_sunbake(setting: Setting) -> Option<&'static str> {
    Some(match setting {
        Setting::TexelsPerMetre => "--texels-per-metre",
        Setting::ObjectDensity => "--density",
        Setting::ObjectDensityAround => "--density-around",
        Setting::Padding => "--padding",
        Setting::Bits => "--bits",
        Setting::Layers => "--layers",
        Setting::Lanes => "--lanes",
        Setting::Engine => "--engine",
        Setting::Contents => "--only",
        Setting::LossMap => "--loss-map",
        Setting::Exr => "--exr",
        Setting::AoRays => "--ao-rays",
        Setting::AoError => "--ao-error",
        Setting::AoSupersample => "--ao-supersample",
        Setting::MaxMemory => "--max-memory",
        Setting::Path => "--path",
        Setting::Lamp => "--lamp",
        shared => return option_of_both(shared),
    })
}

fn option_of_sunplay(setting: Setting) -> Option<&'static str> {
    Some(match setting {
        Setting::Renderer => "--renderer",
        Setting::Technique => "--technique",
        Setting::MapSize => "--map-size",
        Setting::Cascades => "--cascades",
        Setting::Camera => "--camera",
        Setting::Time => "--at",
        Setting::Reference => "--against",
        shared => return option_of_both(shared),
    })
}

fn option_of_both(setting: Setting) -> Option<&'static str> {
    Some(match setting {
        Setting::Threads => "--threads",
        Setting::LeaveOut => "--leave-out",
        Setting::NoCast => "--no-cast",
        Setting::NoReceive => "--no-receive",
        Setting::Place => "--place",
        Setting::Date => "--date",
        Setting::Output => "-o",
        Setting::Force => "--force",
        _ => return None,
    })
}

/// Remedies that read alike: `give a smaller --size or --lanes`.
struct Clause {
    before: String,
    options: Vec<String>,
    after: &'static str,
}

impl Clause {
    fn new(before: &str, option: impl Into<String>, after: &'static str) -> Self {
        Self { before: before.into(), options: vec![option.into()], after }
    }

    fn text(&self) -> String {
        let options = match self.options.as_slice() {
            [rest @ .., last] if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
            options => options.concat(),
        };
        [self.before.as_str(), &options, self.after]
            .into_iter()
            .filter(|part| !part.is_empty())
            .collect::<Vec<_>>()
            .join(" ")
    }
}

fn clauses(remedy: &Remedy, command: Command) -> Vec<Clause> {
    let of =
        |before: &str, setting: Setting, after| option(setting, command).map(|name| Clause::new(before, name, after));
    let clause = match remedy {
        Remedy::Change(Setting::Output) => of("choose another folder with", Setting::Output, ""),
        Remedy::Change(Setting::Technique) => of("draw another", Setting::Technique, ""),
        Remedy::Set(Setting::Force, _) => of("replace it with", Setting::Force, ""),
        Remedy::Lower(setting) => of("give a smaller", *setting, ""),
        Remedy::Fewer(setting) => of("give fewer", *setting, ""),
        Remedy::Raise(setting) => of("give a larger", *setting, ""),
        Remedy::Change(setting) => of("give another", *setting, ""),
        Remedy::Omit(setting) => of("leave", *setting, "out"),
        Remedy::Set(setting, value) => {
            let verb = if *setting == Setting::Renderer { "draw with" } else { "give" };
            option(*setting, command).map(|name| Clause::new(verb, format!("{name} {value}"), ""))
        }
        Remedy::SetAll(settings) => {
            let given = |(setting, value): &(Setting, String)| Some(format!("{} {value}", option(*setting, command)?));
            let all: Option<Vec<String>> = settings.iter().map(given).collect();
            all.map(|all| Clause::new("give", format!("both {}", all.join(" and ")), ""))
        }
        Remedy::ListNames => Some(Clause::new("", "list the names with `sunbake inspect SCENE`", "")),
        Remedy::Do(what) => Some(Clause::new("", *what, "")),
        Remedy::Rebake(change) => {
            let how = text(change, Command::Sunbake).map(|text| text.replacen("give ", "", 1));
            how.map(|how| Clause::new("bake again with", how, ""))
        }
        Remedy::AnyOf(remedies) => return remedies.iter().flat_map(|remedy| clauses(remedy, command)).collect(),
    };
    clause.into_iter().collect()
}

/// The remedy as a phrase, in the options of `command`. None if the command has no such option.
pub fn text(remedy: &Remedy, command: Command) -> Option<String> {
    let mut merged: Vec<Clause> = Vec::new();
    for clause in clauses(remedy, command) {
        match merged.last_mut() {
            Some(last) if !clause.before.is_empty() && (&last.before, last.after) == (&clause.before, clause.after) => {
                last.options.extend(clause.options);
            }
            _ => merged.push(clause),
        }
    }
    let mut texts: Vec<String> = merged.iter().map(Clause::text).collect();
    for i in (1..texts.len()).rev() {
        // One verb is enough: `give a smaller --size, or a larger --max-memory`.
        if texts[i - 1].starts_with("give ") && texts[i].starts_with("give ") {
            texts[i] = texts[i].replacen("give ", "", 1);
        }
    }
    (!texts.is_empty()).then(|| texts.join(", or "))
}

/// A sentence with the remedy at its end.
pub fn with_remedy(sentence: String, remedy: Option<&Remedy>, command: Command) -> String {
    match remedy.and_then(|remedy| text(remedy, command)) {
        Some(remedy) => format!("{sentence}; {remedy}"),
        None => sentence,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remedies_read_as_phrases() {
        let memory = Remedy::any([
            Remedy::Lower(Setting::PageSize),
            Remedy::Lower(Setting::Lanes),
            Remedy::Raise(Setting::MaxMemory),
        ]);
        let text = |remedy: &Remedy, command| text(remedy, command).unwrap_or_default();
        assert_eq!(text(&memory, Command::Sunbake), "give a smaller --size or --lanes, or a larger --max-memory");
        assert_eq!(text(&memory, Command::Sunplay), "give a smaller --page-size");
        let folder = Remedy::any([Remedy::Change(Setting::Output), Remedy::Set(Setting::Force, String::new())]);
        assert_eq!(text(&folder, Command::Sunplay), "choose another folder with -o, or replace it with --force");
        let limit = Remedy::any([
            Remedy::Set(Setting::Renderer, "cpu".into()),
            Remedy::Rebake(Box::new(Remedy::Lower(Setting::PageSize))),
        ]);
        assert_eq!(text(&limit, Command::Sunplay), "draw with --renderer cpu, or bake again with a smaller --size");
        let names = Remedy::any([Remedy::Change(Setting::NoCast), Remedy::ListNames]);
        assert_eq!(
            text(&names, Command::Sunplay),
            "give another --no-cast, or list the names with `sunbake inspect SCENE`"
        );
        let set = |setting| (setting, "sky".to_owned());
        let dome = Remedy::any([
            Remedy::Set(Setting::LeaveOut, "sky".into()),
            Remedy::SetAll(vec![set(Setting::NoCast), set(Setting::NoReceive)]),
        ]);
        assert_eq!(text(&dome, Command::Sunbake), "give --leave-out sky or both --no-cast sky and --no-receive sky");
        assert_eq!(text(&Remedy::Omit(Setting::Lamp), Command::Sunbake), "leave --lamp out");
        assert_eq!(text(&Remedy::Omit(Setting::Lamp), Command::Sunplay), "");
    }
}
