# What each file rests on, as one digest: the code and the options that make it, and the same of all
# that it is made of.
#
# Each rule has this digest among its params, so that a file is made again when anything changed that
# it hangs on, however far away. Snakemake's own records do not see to that: of a job that dies they
# keep the new inputs as if it had ended, and its output is deleted; what hangs on a change only
# through the deleted file then looks up to date, and the old figure stays. (Functions of the
# wildcards alone: params that take `input` are left out of the comparison.)


def digest_of(*parts):
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:16]


@cache
def code(script, *names):
    """Digest of a script and of the code that modules or functions depend on; a comment or the
    layout of code does not change it."""
    return source.digest(*names, script=Path(workflow.basedir, f"workflow/scripts/{script}.py"))


@cache
def response_recipe(run):
    scene, numerics = RUNS[run].scene.to_json(), RUNS[run].numerics
    return digest_of(code("simulate", source.RUN, "fiberweb.simulation.dataset"), scene, numerics)


@cache
def capacity_recipe(run):
    made_by = code("capacity", "fiberweb.scoring.capacity", "fiberweb.simulation.dataset")
    return digest_of(made_by, RUNS[run].scoring, response_recipe(run))


def runs_recipe(study, setup):
    """What decides which of the runs that a study may have it has: the ridge, for some."""
    if not waits(study, setup):
        return ""
    return digest_of(code("table", f"fiberweb.studies.{study}"), best_recipe(setup))


def table_recipe(file, setup):
    if file == BEST:
        return best_recipe(setup)
    if file not in TABLES:
        return OWN_RECIPES[file]
    study = TABLES[file]
    possible = known_runs(study, setup)  # all, for the checkpoint need not be there yet
    section, spec, chosen = table_spec(file, possible)
    return digest_of(
        code("table", spec.make, "fiberweb.products"),
        (spec.make, spec.single, spec.options(section, chosen)),
        [run.choice for run in chosen] if spec.choices else [],
        runs_recipe(study, setup),
        [table_recipe(given, setup) for given in spec.tables],
        [capacity_recipe(run.name) for run in chosen] if spec.capacities else [],
        [response_recipe(run.name) for run in chosen] if spec.responses else [],
    )


def best_recipe(setup):
    made_by = code("table", "fiberweb.studies.ridge.best", "fiberweb.products")
    return digest_of(made_by, table_recipe("ridge.csv", setup))


def figure_recipe(name, setup):
    study, spec = figure_spec(name, setup)
    return digest_of(
        code("figure", spec.draw, "fiberweb.products"),
        (spec.draw, spec.options(getattr(CONFIG, study))),
        [table_recipe(file, setup) for file in spec.given],
        responses_recipe(study, setup) if spec.responses else "",
    )


def responses_recipe(study, setup):
    """Of all responses of a study."""
    responses = [response_recipe(run.name) for run in known_runs(study, setup)]
    return digest_of(runs_recipe(study, setup), responses)


def claims_recipe(setup):
    return digest_of(
        code("claims", "fiberweb.claims.judge", "fiberweb.products", *studies.claims()),
        [table_recipe(file, setup) for file in judged(setup)],
        [hashlib.sha256(Path(path).read_bytes()).digest() for path in authors_tables()],
    )
