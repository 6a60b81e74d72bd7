"""Doubts in German: a title, what is said of one and of several with their names, what to do."""

DOUBTS = {
    "access-gap": (
        "Was erlaubt ist, ist nicht bekannt",
        "was {names} erlaubt, ist nicht bekannt",
        "an {n} Stellen ist nicht bekannt, was erlaubt ist ({names})",
        "die Warnungen zu diesen Dateien und die durchgesetzte Sicht ansehen (--view enforced)",
    ),
    "analysed-in-parts": (
        "Eine Antwort über eine Flotte in Teilen",
        "von Robotern, die nicht gezeigt werden, sind keine Zweifel genannt",
        "von Robotern, die nicht gezeigt werden, sind keine Zweifel genannt",
        "die ganze Flotte im Speicher analysieren, oder die Roboter, auf die es ankommt",
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
    "careful-deny": (
        "Eine Suche, die eine Schranke abgebrochen hat",
        "eine Schranke hat abgebrochen, was ein DENY in {names} von Wildcards übrig lässt",
        "eine Schranke hat abgebrochen, was {n} DENY von Wildcards übrig lassen ({names})",
        "die Schranke der Vergleiche anheben",
    ),
    "empty-group": (
        "Zeilen einer Policy, die nichts erlauben",
        "eine Gruppe von Zeilen in {names} hat keine Regel und erlaubt nichts",
        "{n} Gruppen von Zeilen haben keine Regel und erlauben nichts ({names})",
        'dort publish="ALLOW" oder dergleichen schreiben, oder sie entfernen',
    ),
    "empty-include": (
        "Eine Einbindung, die nichts bringt",
        "eine Einbindung in {names} bringt nichts",
        "{n} Einbindungen bringen nichts ({names})",
        "berichtigen, was die Einbindung auswählt, oder sie entfernen",
    ),
    "fallback-taken": (
        "Ein Ersatz wurde genommen",
        "in {names} wurde ein Ersatz (fallback) genommen",
        "{n} Mal wurde ein Ersatz (fallback) genommen ({names})",
        "die eingebundene Datei beilegen oder den Ersatz entfernen",
    ),
    "joins-nothing": (
        "Eine Domain oder Infrastruktur, die nichts verbindet",
        "eine Domain oder Infrastruktur in {names} ist mit nichts verbunden",
        "{n} Domains oder Infrastrukturen sind mit nichts verbunden ({names})",
        "die Domain oder einen Fluss dorthin nennen; die Domain weglassen, wenn sie allein stehen soll",
    ),
    "leak-joins-nothing": (
        "Eine Domain oder Infrastruktur, die Daten hinauslässt und nichts verbindet",
        "eine Domain oder Infrastruktur in {names}, die Daten hinauslässt oder aufbewahrt, ist mit nichts verbunden",
        "{n} Domains oder Infrastrukturen, die Daten hinauslassen oder aufbewahren, sind mit nichts verbunden ({names})",
        "die Domain oder einen Fluss dorthin nennen; die Domain weglassen, wenn sie allein stehen soll",
    ),
    "made-without-warnings": (
        "Ein Text über den Betrieb, der ohne Warnungen entstand",
        "der Text hinter {names} entstand ohne Warnungen",
        "{n} Texte über den Betrieb entstanden ohne Warnungen ({names})",
        "den Text mit -a, --include-hidden und 2>&1 neu machen und noch einmal beobachten",
    ),
    "mistaken-tilde": (
        "Ein Name hinter ~ ohne /",
        "ein Name in {names} hat kein / hinter ~ und ist ein anderer Name",
        "{n} Namen haben kein / hinter ~ und sind andere Namen ({names})",
        "~/ davor schreiben",
    ),
    "infrastructure-closes": (
        "Nur die Datei der Infrastruktur schließt den Weg zu einem Ausgang",
        "nur die Datei der Infrastruktur schließt den Weg zu einem Ausgang bei {names}",
        "nur die Datei der Infrastruktur schließt die Wege zu Ausgängen bei {n} Kanälen ({names})",
        "ansehen, was der Kanal trägt, und es angeben",
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
    "no-robot": (
        "Ordner einer Gruppe von Robotern ohne deren Policy",
        "Ordner einer Gruppe in {names} haben keine Policy und sind keine Roboter",
        "Ordner von {n} Gruppen haben keine Policy und sind keine Roboter ({names})",
        "diesen Ordnern die Policy geben oder sie verlegen",
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
    "odd-namespace": (
        "Ein Namensraum, der nicht mit / beginnt",
        "ein Namensraum in {names} beginnt nicht mit /",
        "{n} Namensräume beginnen nicht mit / ({names})",
        "/ davor schreiben",
    ),
    "paths-not-counted": (
        "Eine Suche, die eine Grenze abbrach",
        "eine Grenze brach die Zählung von Wegen ab",
        "eine Grenze brach {n} Zählungen von Wegen ab",
        "die Grenze anheben oder nach weniger Arten von Daten fragen",
    ),
    "refused-name": (
        "Ein Name, den kein ROS-Knoten haben kann",
        "ein Name in {names} ist keiner, den ein ROS-Knoten haben kann",
        "{n} Namen sind keine, die ein ROS-Knoten haben kann ({names})",
        "den Namen berichtigen: er trifft keinen anderen oder die falschen",
    ),
    "restricted": (
        "Gefragt war nur nach manchen Arten von Daten",
        "gefragt war nur nach manchen Arten von Daten",
        "gefragt war nur nach manchen Arten von Daten",
        "nach allen Arten fragen",
    ),
    "standard-closes": (
        "Nur die Datei der Standardkanäle schließt den Weg zu einem Ausgang, an einem Kanal, der nicht an seinem Platz ist",
        "nur die Datei der Standardkanäle schließt den Weg zu einem Ausgang bei {names}, und das ist kein Standardkanal an seinem Platz",
        "nur die Datei der Standardkanäle schließt die Wege zu Ausgängen bei {n} Kanälen, die nicht an ihrem Platz sind ({names})",
        "ansehen, was der Kanal trägt, und es mit vollem Namen angeben",
    ),
    "type-closes": (
        "Nur der Typ eines Kanals schließt den Weg zu einem Ausgang",
        "nur der Typ eines Kanals schließt den Weg zu {names}",
        "nur die Typen von Kanälen schließen die Wege zu {n} Ausgängen ({names})",
        "ansehen, was der Kanal trägt, und es angeben",
    ),
    "types-of-nothing": (
        "Beobachtete Typen von etwas, das es hier nicht gibt",
        "{names} nennt Typen von Kanälen oder Knoten, die es hier nicht gibt",
        "{n} Dateien nennen Typen von Kanälen oder Knoten, die es hier nicht gibt ({names})",
        "auch die Policy dessen angeben, was im Betrieb gesehen wurde, oder die Datei dieses Systems",
    ),
    "unread-file": (
        "Eine Datei mit Rechten, die nicht gelesen wurde",
        "{names} wurde nicht gelesen",
        "{n} Dateien wurden nicht gelesen ({names})",
        "die Datei nennen oder die Policy, die sie einbindet, oder sie aus dem Ordner nehmen",
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
