# Recordings of real bodies, from the files that the config lists to a score card of each. One that
# cannot be used is refused with a sentence in its own folder, and the others go on.


rule recordings:
    input:
        cards,


rule recording:
    input:
        recorded_file,
    output:
        response="<results>/recordings/{recording}/recording.nc",
        sanity="<results>/recordings/{recording}/sanity.csv",
    log:
        "<logs>/recordings/{recording}.log",
    conda:
        "../../envs/environment.yaml"
    params:
        path=lambda wildcards: str(RECORDED[wildcards.recording].path),
        options=lambda wildcards: RECORDED[wildcards.recording].read,
        recipe=of_recording(),
    message:
        "Reading {wildcards.recording}"
    script:
        "../scripts/recording.py"


rule card:
    input:
        "<results>/recordings/{recording}/recording.nc",
    output:
        table="<results>/recordings/{recording}/card.csv",
        json="<results>/recordings/{recording}/card.json",
        png=report(
            "<results>/recordings/{recording}/card.png",
            caption="../report/card.rst",
            category="Recordings",
        ),
        pdf="<results>/recordings/{recording}/card.pdf",
    log:
        "<logs>/recordings/{recording}-card.log",
    conda:
        "../../envs/environment.yaml"
    params:
        options=lambda wildcards: RECORDED[wildcards.recording].card,
        recipe=lambda wildcards: of_card(RECORDED[wildcards.recording].read),
    message:
        "Scoring the recording {wildcards.recording}"
    script:
        "../scripts/card.py"
