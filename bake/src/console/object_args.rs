//! The options that say what becomes of objects, by their names.

use crate::scene::ObjectWishes;
use clap::Args;

/// Wishes for materials, nodes and meshes of a scene.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Objects")]
pub struct ObjectArgs {
    /// Leave a material, node or mesh out: it is not drawn, not baked and casts nothing. May be given several times.
    ///
    /// For outline hulls, sky domes, collision shells. NAME may hold `*` for any text; what has no name is material:3,
    /// node:12 or mesh:0, by its index in the file (`sunbake inspect SCENE` lists them). A node takes all below it. The
    /// same can stand in the file, as extras (custom properties) of a node, mesh or material: sunbake_leave_out,
    /// sunbake_no_cast and sunbake_no_receive, true or false, and sunbake_density and sunbake_density_around, numbers.
    /// Options come before them.
    #[arg(long, value_name = "NAME")]
    pub leave_out: Vec<String>,
    /// Let a material, node or mesh cast no shadow: it is drawn and baked, and light passes it. As --leave-out.
    #[arg(long, value_name = "NAME")]
    pub no_cast: Vec<String>,
    /// Let nothing shade a material, node or mesh: it is drawn and casts, and has no texels. As --leave-out.
    #[arg(long, value_name = "NAME")]
    pub no_receive: Vec<String>,
}

/// Densities of materials, nodes and meshes of a scene.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Objects")]
pub struct DensityArgs {
    /// Texels per metre of a material, node or mesh, whatever the others have. NAME is read as by --leave-out.
    ///
    /// More for what is small or near the eye, less for a landscape. The others share what is left of the page.
    #[arg(long, value_name = "NAME=X", value_parser = parse_density_of)]
    pub density: Vec<(String, f64)>,
    /// At least X texels per metre on a material, node or mesh, and on what its shadow falls on: all triangles nearer
    /// to its box than the box is long.
    #[arg(long, value_name = "NAME=X", value_parser = parse_density_of)]
    pub density_around: Vec<(String, f64)>,
}

impl DensityArgs {
    /// Whether any of it is given.
    pub fn is_given(&self) -> bool {
        !(self.density.is_empty() && self.density_around.is_empty())
    }
}

impl ObjectArgs {
    /// Whether any of it is given.
    pub fn is_given(&self) -> bool {
        self.wishes() != ObjectWishes::default()
    }

    /// As wishes.
    pub fn wishes(&self) -> ObjectWishes {
        let Self { leave_out, no_cast, no_receive } = self.clone();
        ObjectWishes { leave_out, no_cast, no_receive, ..ObjectWishes::default() }
    }

    /// As wishes, with densities.
    pub fn wishes_with(&self, densities: &DensityArgs) -> ObjectWishes {
        let DensityArgs { density, density_around } = densities.clone();
        ObjectWishes { density, density_around, ..self.wishes() }
    }
}

/// Reads `NAME=X`. A name may hold a `=` itself.
fn parse_density_of(text: &str) -> Result<(String, f64), String> {
    let wrong = || format!("`{text}` is no name with texels per metre: give NAME=X, with X from 0.000001 to 1000000");
    let (name, density) = text.rsplit_once('=').ok_or_else(wrong)?;
    let density = density.parse().ok().filter(|&density| crate::scene::is_density(density)).ok_or_else(wrong)?;
    Ok((name.to_owned(), density))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_density_is_a_name_and_a_number() {
        assert_eq!(parse_density_of("bench=40"), Ok(("bench".into(), 40.0)));
        assert_eq!(parse_density_of("a=b=0.5"), Ok(("a=b".into(), 0.5)));
        for bad in ["bench", "bench=", "bench=x", "bench=-1", "bench=0", "bench=inf", "=nan"] {
            assert!(parse_density_of(bad).is_err_and(|e| e.contains("NAME=X")), "{bad}");
        }
    }
}
