//! The dicts that describe a problem, as views of the core.

/// `let view = Kind { field: dict["key"], ... }`, named `name` in messages.
macro_rules! read {
    ($view:ident = $kind:ident from $dict:ident { $($field:ident: $key:literal),* $(,)? }) => {
        $(let $field = crate::arrays::Held::entry($dict, stringify!($dict), $key)?;)*
        let $view = rga_core::$kind { $($field: $field.view()),* };
    };
}

macro_rules! read_structure {
    ($model:ident from $structure:ident) => {
        crate::read::read!($model = Structure from $structure {
            coordinates: "coordinates",
            ends: "ends",
            frame: "frame",
            young: "E",
            shear: "G",
            area: "A",
            iy: "Iy",
            iz: "Iz",
            torsion: "J",
            shear_area_y: "Asy",
            shear_area_z: "Asz",
            local_y: "local_y",
            connection: "connection",
            rigid_end: "rigid_end",
            fixed: "fixed",
            inclined_node: "inclined_node",
            inclined_direction: "inclined_direction",
            spring_node: "spring_node",
            spring_dof: "spring_dof",
            spring_stiffness: "spring_stiffness",
            tie_node: "tie_node",
            tie_dof: "tie_dof",
        });
    };
}

macro_rules! read_loads {
    ($patterns:ident from $loads:ident) => {
        crate::read::read!($patterns = Loads from $loads {
            forces: "forces",
            strain: "strain",
            prescribed: "prescribed",
            prescribed_inclined: "prescribed_inclined",
            member_pattern: "member_pattern",
            member_index: "member_index",
            member_axis: "member_axis",
            member_from: "member_from",
            member_to: "member_to",
            member_start: "member_start",
            member_end: "member_end",
        });
    };
}

macro_rules! read_masses {
    ($weights:ident from $masses:ident) => {
        crate::read::read!($weights = Masses from $masses {
            line: "line",
            section: "section",
            nodal: "nodal",
        });
    };
}

macro_rules! read_outputs {
    ($wanted:ident from $outputs:ident) => {
        crate::read::read!($wanted = Outputs from $outputs {
            kind: "kind",
            index: "index",
            other: "other",
            vector: "vector",
            total: "total",
        });
    };
}

/// The three views of a problem, from the dicts of `respond`.
macro_rules! read_problem {
    ($model:ident, $patterns:ident, $wanted:ident from $structure:ident, $loads:ident, $outputs:ident) => {
        crate::read::read_structure!($model from $structure);
        crate::read::read_loads!($patterns from $loads);
        crate::read::read_outputs!($wanted from $outputs);
    };
}

pub(crate) use {read, read_loads, read_masses, read_outputs, read_problem, read_structure};
