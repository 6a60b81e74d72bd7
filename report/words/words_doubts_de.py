"""Doubts in German: a title, what is said of one and of several with their names, what to do."""

DOUBTS = {
    "access-gap": (
        "Was erlaubt ist, ist nicht bekannt",
        "was {names} erlaubt, ist nicht bekannt",
        "an {n} Stellen ist nicht bekannt, was erlaubt ist ({names})",
        "die Warnungen zu diesen Dateien und die durchgesetzte Sicht ansehen (--view enforced)",
    ),
    "backups-not-stated": (
        "Ein Speicher, über dessen Sicherungskopien nichts angegeben ist",
        "Sicherungskopien von {names} sind nicht angegeben, angenommen werden keine",
        "Sicherungskopien von {n} Speichern sind nicht angegeben, angenommen werden keine ({names})",
        "in der Datei der Angaben sagen: backups: P30D oder backups: false",
    ),
    "bag-gap": (
        "Eine Aufzeichnung ist nicht ganz bekannt",
        "von der Aufzeichnung {names} ist nicht alles bekannt",
        "von {n} Aufzeichnungen ist nicht alles bekannt ({names})",
        "die Policies des aufgezeichneten Systems nennen oder die Aufzeichnung reparieren (rosprivacy bag sagt, was fehlt)",
    ),
    "by-globs": (
        "Nur ein Muster spricht für ein Element",
        "nur ein Muster spricht für {names}",
        "nur Muster sprechen für {n} Elemente ({names})",
        "jedes ansehen, dann festhalten, was gesehen wurde: rosprivacy labels --pin",
    ),
    "empty-group": (
        "Eine Gruppe von Robotern ohne Regel oder ohne Inhalt",
        "in einer Gruppe von Robotern ist nichts ({names})",
        "in {n} Gruppen von Robotern ist nichts ({names})",
        "die Flottendatei berichtigen",
    ),
    "fallback-taken": (
        "Ein Ersatz wurde genommen",
        "in {names} wurde ein Ersatz (fallback) genommen",
        "{n} Mal wurde ein Ersatz (fallback) genommen ({names})",
        "die eingebundene Datei beilegen oder den Ersatz entfernen",
    ),
    "no-flow": (
        "Ein Element außerhalb von ROS, zu dem kein Fluss führt",
        "zu {names} führt kein Fluss",
        "zu {n} Elementen außerhalb von ROS führt kein Fluss ({names})",
        "in der Datei der Angaben sagen, was dorthin fließt, oder das Element entfernen",
    ),
    "no-reader": (
        "Daten, die niemand Bekanntes liest",
        "{names} endet bei keinem bekannten Leser",
        "{n} Kanäle enden bei keinem bekannten Leser ({names})",
        "die Policy des Lesers dazugeben oder nachsehen, wer liest (rosprivacy observe)",
    ),
    "nothing-enforced": (
        "Für das Beobachtete wird nichts durchgesetzt",
        "für {n} Knoten wird nichts durchgesetzt ({names})",
        "für {n} Knoten wird nichts durchgesetzt ({names})",
        "ansehen, was jedes Programm im Netz lesen kann (--view both); die Policy, die rosprivacy observe geschrieben hat, kann durchgesetzt werden: ros2 security generate_artifacts -k KEYSTORE -p POLICY, und ROS_SECURITY_STRATEGY=Enforce",
    ),
    "observation-gap": (
        "Eine Beobachtung, der bekanntermaßen etwas fehlt",
        "der Beobachtung fehlt bekanntermaßen etwas ({names})",
        "der Beobachtung fehlt bekanntermaßen {n} Mal etwas ({names})",
        "noch einmal beobachten, bis keine Lücke bleibt (rosprivacy observe), oder eine Policy nennen",
    ),
    "paths-not-counted": (
        "Eine Suche, die eine Grenze abbrach",
        "eine Grenze brach die Zählung von Wegen ab",
        "eine Grenze brach {n} Zählungen von Wegen ab",
        "die Grenze anheben oder nach weniger Arten von Daten fragen",
    ),
    "restricted": (
        "Gefragt war nur nach manchen Arten von Daten",
        "gefragt war nur nach manchen Arten von Daten",
        "gefragt war nur nach manchen Arten von Daten",
        "nach allen Arten fragen",
    ),
    "type-closes": (
        "Nur der Typ eines Kanals schließt den Weg zu einem Ausgang",
        "nur der Typ eines Kanals schließt den Weg zu {names}",
        "nur die Typen von Kanälen schließen die Wege zu {n} Ausgängen ({names})",
        "ansehen, was der Kanal trägt, und es angeben",
    ),
    "unread-file": (
        "Eine Datei mit Rechten, die nicht gelesen wurde",
        "{names} wurde nicht gelesen",
        "{n} Dateien wurden nicht gelesen ({names})",
        "die Datei nennen oder die Policy, die sie einbindet, oder sie entfernen",
    ),
}
WORDS = {
    "r.answer": "Die Antwort, auf der dieses Verzeichnis beruht",
    "h.doubts": "Zweifel",
    "doubt.sentence": "In Zweifel: {doubts}.",
    "verdict.doubtful": "Nicht bestimmt: Nicht alles ist bekannt",
    "verdict.doubtful.means": "Es wurde kein Weg zu einem Empfänger gefunden, aber etwas, das einen verbergen kann, ist nicht bekannt: Der Abschnitt über Zweifel nennt es. Solange es nicht bekannt ist, lässt sich nichts schließen.",
    "doubt.accepted.one": "{n} Zweifel akzeptiert",
    "doubt.accepted.many": "{n} Zweifel akzeptiert",
    "doubt.list": "Zweifel: was nicht bekannt ist oder auf mehr als dem Wort eines Menschen beruht ({n})",
    "doubt.breaks": "bricht die Aussage",
    "doubt.rides": "gehört zur Aussage",
    "doubt.is.accepted": "bis {date} akzeptiert von {owner}: {reason}",
    "doubt.what.to.do": "Was zu tun ist: {do}",
    "doubt.none": "Es ist kein Zweifel bekannt.",
    **{
        f"doubt.{name}.{part}": text
        for name, texts in DOUBTS.items()
        for part, text in zip(("title", "one", "many", "do"), texts, strict=True)
    },
}
